// Forces on solids from given pressures and velocities with exact answers.
#include <gtest/gtest.h>

#include <cmath>

#include "base/maths.h"
#include "coupling/solids_on_grid.h"

namespace smokebox {
namespace {

struct Case {
  Boundary boundary;
  SolidsOnGrid grid;
  std::vector<MovingSolid> solids;
  Field pressure, u, v;

  Case(Grid g, std::vector<MovingSolid> given)
      : solids(std::move(given)), pressure(g.nx, g.ny), u(g.nx, g.ny), v(g.nx, g.ny) {
    boundary.grid = g;
    grid.cover(solids, true, boundary);
  }
  template <class P>
  void setPressure(P&& p) {
    for (int j = 0; j < boundary.grid.ny; ++j)
      for (int i = 0; i < boundary.grid.nx; ++i) {
        const bool fluid = boundary.volume(i, j) > 0;
        pressure(i, j) =
            fluid ? static_cast<float>(p(boundary.grid.cellCentre(i, j))) : 1e6f;  // must not be read
      }
  }
  SurfaceForce force(double viscosity = 0) const {
    SurfaceShear shear;
    findSurfaceShear(boundary, u, v, shear);
    return surfaceForces(boundary, solids, pressure, shear, viscosity)[0];
  }
};

MovingSolid solidOf(const Shape& shape, Pose pose) {
  MovingSolid solid;
  solid.outlines = outlinesOf({shape, pose}, 1e-7);
  solid.origin = pose.position;
  solid.drag = 1;
  return solid;
}

TEST(SurfaceForces, ConstantPressurePushesNothing) {
  // A closed surface in a constant pressure feels no force and no torque, whatever its shape.
  for (const Shape& shape :
       {Shape{CircleShape{0.2}}, Shape{BoxShape{{0.5, 0.004}}}, Shape{BoxShape{{0.3, 0.2}}},
        Shape{PolygonShape{{{-0.2, -0.2}, {0.2, -0.2}, {0, 0}, {0.2, 0.2}, {-0.2, 0.2}}}}}) {
    Case c({64, 64, 1.0 / 64}, {solidOf(shape, {{0.52, 0.47}, 0.3})});
    c.setPressure([](Vec2) { return 3.0; });
    const SurfaceForce f = c.force();
    EXPECT_NEAR(f.force.x, 0, 1e-9);
    EXPECT_NEAR(f.force.y, 0, 1e-9);
    EXPECT_NEAR(f.torque, 0, 1e-9);
  }
}

TEST(SurfaceForces, LinearPressurePushesByTheArea) {
  // p = a x + b y gives the force -(a, b) times the area, through the centre of mass (Archimedes).
  for (const Shape& shape :
       {Shape{CircleShape{0.2}}, Shape{BoxShape{{0.5, 0.004}}}, Shape{RegularShape{3, 0.2}},
        Shape{PolygonShape{{{-0.2, -0.2}, {0.2, -0.2}, {0, 0}, {0.2, 0.2}, {-0.2, 0.2}}}}}) {
    Case c({64, 64, 1.0 / 64}, {solidOf(shape, {{0.52, 0.47}, 0.3})});
    c.setPressure([](Vec2 p) { return 2 * p.x - 3 * p.y; });
    const SurfaceForce f = c.force();
    const MassProperties mass = massProperties(c.solids[0].outlines);
    EXPECT_NEAR(f.force.x, -2 * mass.area, 2e-6);
    EXPECT_NEAR(f.force.y, 3 * mass.area, 2e-6);
    EXPECT_NEAR(f.torque, cross(mass.centre - c.solids[0].origin, {-2 * mass.area, 3 * mass.area}), 2e-6);
  }
}

TEST(SurfaceForces, ThinPlateFeelsTheDifferenceOfItsSides) {
  // A plate thinner than a cell, 5 Pa on one side and 2 on the other: 3 Pa times its length.
  const double h = 1.0 / 64;
  for (double y : {0.5, 0.5 + 0.25 * h, 0.5 + 0.45 * h, 0.5 - 0.3 * h}) {
    Case c({64, 64, h}, {solidOf(BoxShape{{2, 0.2 * h}}, {{0.5, y}, 0})});
    c.setPressure([y](Vec2 p) { return p.y > y ? 5.0 : 2.0; });
    // The cells that the plate cuts keep their larger part.
    for (int i = 0; i < 64; ++i) {
      const int j = static_cast<int>(y / h);
      const double local = y / h - j;
      if (local > 0.1 && local < 0.9) c.pressure(i, j) = local < 0.5 ? 5 : 2;
    }
    EXPECT_NEAR(c.force().force.y, -3, 2e-2) << y;
    EXPECT_NEAR(c.force().force.x, 0, 1e-6) << y;
  }
}

TEST(SurfaceForces, RotatingDiskFeelsTheViscousTorque) {
  // Flow u = k r (1 - R^2 / r^2) around a disk at rest: shear 2 mu k on the surface, torque 4 pi mu k R^2.
  for (int n : {32, 64, 128, 256}) {
    const double radius = 0.2, k = 1.5, mu = 0.3;
    const Vec2 centre{0.503, 0.497};
    Case c({n, n, 1.0 / n}, {solidOf(CircleShape{radius}, {centre, 0})});
    auto flow = [&](Vec2 p) {
      const Vec2 r = p - centre;
      const double rr = dot(r, r);
      return rr > radius * radius ? k * (1 - radius * radius / rr) * perpendicular(r) : Vec2{};
    };
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        c.u(i, j) = static_cast<float>(flow(c.boundary.grid.xFaceCentre(i, j)).x);
        c.v(i, j) = static_cast<float>(flow(c.boundary.grid.yFaceCentre(i, j)).y);
      }
    const SurfaceForce f = c.force(mu);
    const double error = std::fabs(f.torque / (4 * kPi * mu * k * radius * radius) - 1);
    EXPECT_LT(error, 1.0 / n) << n;
    EXPECT_NEAR(f.force.x, 0, 0.02);
    c.solids[0].drag = 0;  // full slip
    c.grid.cover(c.solids, false, c.boundary);
    EXPECT_EQ(c.force(mu).torque, 0);
  }
}

TEST(SurfaceForces, DiskThatTurnsWithItsFluidFeelsNone) {
  // Rigid rotation of all has no stress: shear of the links and its transpose cancel.
  const int n = 64;
  MovingSolid disk = solidOf(CircleShape{0.2}, {{0.5, 0.5}, 0});
  disk.spin = 2;
  Case c({n, n, 1.0 / n}, {disk});
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      c.u(i, j) = static_cast<float>(disk.velocityAt(c.boundary.grid.xFaceCentre(i, j)).x);
      c.v(i, j) = static_cast<float>(disk.velocityAt(c.boundary.grid.yFaceCentre(i, j)).y);
    }
  EXPECT_NEAR(c.force(1).torque, 0, 0.02 * 2 * 2 * kPi * 0.04);
}

}  // namespace
}  // namespace smokebox

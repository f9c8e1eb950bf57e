// Cloth: many springs at once.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "base/maths.h"
#include "support/links_world.h"

namespace smokebox {
namespace {

using test::LinksWorld;

constexpr double kGravity = 9.81;

/// nx by ny cells of 1 / nx metres, 0.05 kg, its lower left corner at (0, 0); springs to the next, across the
/// cells and to the next but one.
struct Cloth {
  LinksWorld world;
  int nx, ny;

  Cloth(int cellsX, int cellsY, double stiffness, double damping, bool pinned, double tear = 1e9)
      : nx(cellsX), ny(cellsY) {
    const double a = 1.0 / nx, mass = 0.05 / ((nx + 1) * (ny + 1));
    for (int j = 0; j <= ny; ++j)
      for (int i = 0; i <= nx; ++i)
        world.particle({i * a, j * a}, pinned && j == ny && (i == 0 || i == nx) ? 0 : mass);
    const int ways[][2] = {{1, 0}, {0, 1}, {1, 1}, {-1, 1}, {2, 0}, {0, 2}};
    for (int j = 0; j <= ny; ++j)
      for (int i = 0; i <= nx; ++i)
        for (const auto& [di, dj] : ways) {
          if (i + di < 0 || i + di > nx || j + dj > ny) continue;
          SpringDef def;
          def.from = {at(i, j), {}}, def.to = {at(i + di, j + dj), {}};
          def.length = a * std::sqrt(1.0 * (di * di + dj * dj));
          def.stiffness = stiffness, def.damping = damping;
          def.tear = tear;
          world.springs.add(def, world.bodies);
        }
  }
  int at(int i, int j) const { return j * (nx + 1) + i; }
  Vec2 place(int i, int j) const { return world.bodies.position[at(i, j)]; }
};

TEST(RigidCloth, SagsTheSameAtAnyStep) {
  // Truth: the equilibrium of a hung cloth knows nothing of the step: at 1/30, 1/60 and 1/240 s its middle
  // and its lower edge are at the same height, within 0.5% of the sag (2% is asked for).
  double middle[3], edge[3];
  const double steps[] = {1.0 / 30, 1.0 / 60, 1.0 / 240};
  for (int k = 0; k < 3; ++k) {
    Cloth cloth(20, 12, 20, 0.01, true);
    cloth.world.gravity = {0, -kGravity};
    cloth.world.drag = 3;
    for (int step = 0; step < std::lround(8 / steps[k]); ++step) cloth.world.step(steps[k], 16);
    EXPECT_LT(cloth.world.kinetic(), 1e-9);
    middle[k] = cloth.place(10, 12).y - 0.6;
    edge[k] = cloth.place(10, 0).y;
  }
  std::printf("cloth: sag %.6f, off by %.1e, %.1e; lower edge %.6f, off by %.1e, %.1e\n", middle[2],
              middle[0] / middle[2] - 1, middle[1] / middle[2] - 1, edge[2], edge[0] / edge[2] - 1,
              edge[1] / edge[2] - 1);
  EXPECT_LT(middle[2], -0.01);
  for (int k = 0; k < 2; ++k) {
    EXPECT_NEAR(middle[k], middle[2], 5e-3 * std::fabs(middle[2]));
    EXPECT_NEAR(edge[k], edge[2], 5e-3 * std::fabs(edge[2]));
  }
}

TEST(RigidCloth, KeepsMomentaWhenItFliesFreely) {
  // Truth: springs are inner forces: momentum stays to rounding however early the solver stops, angular
  // momentum to its tolerance; energy does not grow.
  for (const double stiffness : {20.0, 2000.0}) {
    Cloth cloth(16, 16, stiffness, 0.001, false);
    Bodies& bodies = cloth.world.bodies;
    for (int k = 0; k < bodies.count(); ++k) {
      const Vec2 p = bodies.position[k] - Vec2{0.5, 0.5};
      bodies.velocity[k] = {1 - p.y + 0.3 * std::sin(6 * p.x), p.x, 0, 0};
    }
    auto momentum = [&](double& angular) {
      Vec2 sum;
      angular = 0;
      for (int k = 0; k < bodies.count(); ++k) {
        const Vec2 each = bodies.def[k].mass * bodies.velocity[k].linear();
        sum = sum + each;
        angular += cross(bodies.position[k], each);
      }
      return sum;
    };
    double spin = 0, spinThen = 0;
    const Vec2 before = momentum(spin);
    const double energy = cloth.world.kinetic();
    double most = 0;
    for (int k = 0; k < 120; ++k) {
      cloth.world.step(1.0 / 60, 16);
      most = std::max(most, cloth.world.kinetic() + cloth.world.potential());
    }
    EXPECT_LT(length(momentum(spinThen) - before), 1e-14);
    EXPECT_NEAR(spinThen, spin, (stiffness < 100 ? 1e-5 : 1e-3) * std::fabs(spin));
    EXPECT_LT(most, energy * 1.001);
    EXPECT_NEAR(bodies.velocity[cloth.at(8, 8)].x, 1, 0.2);
  }
}

TEST(RigidCloth, FallsFreelyOnceItIsReleased) {
  // Truth: of a sheet that hung from its upper edge the centre of mass falls as a stone does, from the first
  // sub-step, whatever its springs held before; its momentum is that of the fall to rounding.
  for (const double stiffness : {20.0, 2000.0}) {
    Cloth cloth(16, 12, stiffness, 0.01, false);
    LinksWorld& world = cloth.world;
    Bodies& bodies = world.bodies;
    const double mass = bodies.def[0].mass;
    for (int i = 0; i <= 16; ++i) bodies.inverse[cloth.at(i, 12)] = {};
    world.gravity = {0, -kGravity};
    world.drag = 3;
    for (int k = 0; k < 300; ++k) world.step(1.0 / 60, 16);
    for (int i = 0; i <= 16; ++i) bodies.inverse[cloth.at(i, 12)] = {1 / mass, 0};
    world.drag = 0;
    auto speed = [&] {
      Vec2 sum;
      for (const Motion& v : bodies.velocity) sum = sum + v.linear();
      return 1.0 / bodies.count() * sum;
    };
    const Vec2 start = speed();
    for (int k = 1; k <= 60; ++k) {
      world.step(1.0 / 60, 16);
      const Vec2 off = speed() - start - Vec2{0, -kGravity * k / 60};
      ASSERT_LT(length(off), 1e-10) << stiffness << " N/m, step " << k;
    }
  }
}

TEST(RigidCloth, IsQuietAtAnyStiffness) {
  // Truth: a hung sheet of k dt^2 / m of 2e2 to 2e8 comes to rest without ever gaining energy.
  for (const double stiffness : {200.0, 2e5, 2e8}) {
    Cloth cloth(12, 8, stiffness, 0, true);
    cloth.world.gravity = {0, -kGravity};
    const double start = cloth.world.potential();
    double most = -1e9;
    for (int k = 0; k < 240; ++k) {
      cloth.world.step(1.0 / 30, 16);
      most = std::max(most, cloth.world.kinetic() + cloth.world.potential() - start);
    }
    std::printf("cloth of %.0e N/m: energy at most %+.1e J, kinetic at the end %.1e J\n", stiffness, most,
                cloth.world.kinetic());
    EXPECT_LT(most, 1e-4);
    EXPECT_LT(cloth.world.kinetic(), 1e-4);
  }
}

TEST(RigidCloth, TearsWhereItIsDrawnTooFar) {
  // Truth: what hangs on springs that tear falls; the rest stays and goes on as before.
  Cloth cloth(10, 10, 200, 0.01, true, 0.4);
  cloth.world.gravity = {0, -kGravity};
  const int load = cloth.at(5, 0);
  cloth.world.bodies.def[load].mass = 30;
  cloth.world.bodies.inverse[load] = {1 / 30.0, 0};
  const int all = cloth.world.springs.count();
  for (int k = 0; k < 60; ++k) cloth.world.step(1.0 / 60, 16);
  int left = 0;
  for (int k = 0; k < all; ++k) left += cloth.world.springs.isThere(k);
  std::printf("torn cloth: %d of %d springs are left, the load is at %.2f m\n", left, all,
              cloth.world.bodies.position[load].y);
  EXPECT_LT(left, all);
  EXPECT_GT(left, all / 2);
  EXPECT_LT(cloth.world.bodies.position[load].y, -2);
  for (int j = 5; j <= 10; ++j) EXPECT_GT(cloth.place(5, j).y, -1.5);
}

}  // namespace
}  // namespace smokebox

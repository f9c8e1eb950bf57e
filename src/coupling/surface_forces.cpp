#include <algorithm>
#include <cmath>

#include "coupling/solids_on_grid.h"
#include "coupling/surface_pressure.h"

namespace smokebox {
namespace {

struct Box {
  Vec2 lo{1e300, 1e300}, hi{-1e300, -1e300};
  bool has(Vec2 p) const { return p.x >= lo.x && p.x <= hi.x && p.y >= lo.y && p.y <= hi.y; }
};

Box boxOf(const MovingSolid& solid) {
  Box box;
  for (const Outline& outline : solid.outlines)
    for (Vec2 p : outline) {
      box.lo = {std::min(box.lo.x, p.x), std::min(box.lo.y, p.y)};
      box.hi = {std::max(box.hi.x, p.x), std::max(box.hi.y, p.y)};
    }
  return box;
}

/// Integral of -p n and of its moment over the outline, piece by piece of at most half a cell. Where another
/// solid lies on the surface, or no fluid is near, there is no pressure.
class PressureIntegral {
 public:
  PressureIntegral(const Boundary& boundary, const std::vector<MovingSolid>& solids, const Field& pressure)
      : boundary_(boundary), solids_(solids), pressure_(pressure) {
    for (const MovingSolid& solid : solids) boxes_.push_back(boxOf(solid));
  }

  SurfaceForce on(std::size_t index) const {
    SurfaceForce sum;
    const MovingSolid& solid = solids_[index];
    for (const Outline& outline : solid.outlines)
      for (std::size_t e = 0; e < outline.size(); ++e) {
        const Vec2 a = outline[e], b = outline[e + 1 < outline.size() ? e + 1 : 0];
        const double size = length(b - a);
        if (size == 0) continue;
        const int pieces = std::max(1, static_cast<int>(std::ceil(size / (0.5 * boundary_.grid.h))));
        for (int k = 0; k < pieces; ++k)
          addPiece(index, a + (static_cast<double>(k) / pieces) * (b - a),
                   a + (static_cast<double>(k + 1) / pieces) * (b - a), sum);
      }
    return sum;
  }

 private:
  void addPiece(std::size_t index, Vec2 a, Vec2 b, SurfaceForce& sum) const {
    const Vec2 middle = 0.5 * (a + b), area = -perpendicular(b - a);  // outwards
    if (beyond(boundary_.periodicX(), boundary_.grid.width(), middle.x) ||
        beyond(boundary_.periodicY(), boundary_.grid.height(), middle.y))
      return;
    const Vec2 outwards = (1 / length(area)) * area;
    const Vec2 before = middle + 1e-3 * boundary_.grid.h * outwards;
    for (std::size_t k = 0; k < solids_.size(); ++k)
      if (k != index && boxes_[k].has(before) && contains(solids_[k].outlines, before)) return;
    const PressurePlane plane = pressureNear(boundary_, pressure_, middle, outwards);
    if (!plane.known) return;
    auto moment = [&](Vec2 p) { return -plane.at(p) * cross(p - solids_[index].origin, area); };
    sum.force = sum.force - plane.at(middle) * area;
    sum.torque += (moment(a) + 4 * moment(middle) + moment(b)) / 6;  // Simpson: exact for linear pressure
  }

  static bool beyond(bool periodic, double size, double x) { return !periodic && (x < 0 || x > size); }

  const Boundary& boundary_;
  const std::vector<MovingSolid>& solids_;
  const Field& pressure_;
  std::vector<Box> boxes_;
};

/// Shear along the cut links: viscosity times the slope over a link's width h.
void addShear(const Boundary& boundary, const std::vector<MovingSolid>& solids,
              const std::vector<CutLink>& links, bool ofU, const std::vector<float>& shear,
              double dynamicViscosity, std::vector<SurfaceForce>& forces) {
  const Grid& grid = boundary.grid;
  auto nearestImage = [](bool periodic, double size, double d) {
    return periodic ? d - size * std::round(d / size) : d;
  };
  for (std::size_t k = 0; k < shear.size(); ++k) {
    const CutLink& link = links[k];
    if (link.solid < 0) continue;
    const double pull = dynamicViscosity * link.drag * shear[k];
    const Vec2 from = ofU ? grid.xFaceCentre(link.i, link.j) : grid.yFaceCentre(link.i, link.j);
    const Vec2 place =
        from + (link.theta * grid.h) * Vec2{static_cast<double>(link.di), static_cast<double>(link.dj)};
    Vec2 arm = place - solids[link.solid].origin;
    arm = {nearestImage(boundary.periodicX(), grid.width(), arm.x),
           nearestImage(boundary.periodicY(), grid.height(), arm.y)};
    const Vec2 force = ofU ? Vec2{pull, 0} : Vec2{0, pull};
    forces[link.solid].force = forces[link.solid].force + force;
    forces[link.solid].torque += cross(arm, force);
  }
}

}  // namespace

std::vector<SurfaceForce> surfaceForces(const Boundary& boundary, const std::vector<MovingSolid>& solids,
                                        const Field& pressure, const SurfaceShear& shear,
                                        double dynamicViscosity) {
  const PressureIntegral integral(boundary, solids, pressure);
  std::vector<SurfaceForce> forces;
  for (std::size_t k = 0; k < solids.size(); ++k) forces.push_back(integral.on(k));
  if (dynamicViscosity == 0) return forces;
  addShear(boundary, solids, boundary.linksU, true, shear.u, dynamicViscosity, forces);
  addShear(boundary, solids, boundary.linksV, false, shear.v, dynamicViscosity, forces);
  // The links see the gradient of each component along the link; the stress has its transpose too, which on a
  // surface that turns with its solid adds up to a torque of -2 mu spin area and no force.
  for (std::size_t k = 0; k < solids.size(); ++k)
    forces[k].torque -=
        2 * dynamicViscosity * solids[k].drag * solids[k].spin * massProperties(solids[k].outlines).area;
  return forces;
}

}  // namespace smokebox

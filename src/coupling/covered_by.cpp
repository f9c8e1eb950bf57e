#include "coupling/covered_by.h"

#include <algorithm>
#include <cmath>

namespace smokebox {
namespace {

constexpr double kNear = 1e-4;  // of h: so near to a solid is covered by it; so little farther is as near

/// Of the copies that are added.
class Mean {
 public:
  Mean(const CoveredBy& by, Vec2 p) : by_(by), p_(p) {}

  void add(int copy) {
    const MovingSolid& solid = by_.solids[by_.copies[copy].solid];
    const Vec2 at = p_ - by_.copies[copy].shift, turns = solid.spin * (at - solid.origin);
    if (count_++ == 0) first_ = by_.copies[copy].solid;
    velocity_ = velocity_ + solid.velocityAt(at);
    drag_ += solid.drag - by_.solids[first_].drag;
    largest_ = std::max({largest_, std::fabs(solid.velocity.x), std::fabs(solid.velocity.y),
                         std::fabs(turns.x), std::fabs(turns.y), std::fabs(solid.spin) * by_.grid.h});
  }

  CoveredBy::Surface result() const {
    return {{rounded(velocity_.x / count_, largest_), rounded(velocity_.y / count_, largest_)},
            by_.solids[first_].drag + drag_ / count_,
            first_};
  }

 private:
  const CoveredBy& by_;
  Vec2 p_, velocity_;
  double drag_ = 0, largest_ = 0;  // drag beyond that of the first
  int count_ = 0, first_ = -1;
};

}  // namespace

double rounded(double value, double largest) {
  if (!(largest > 1e-200)) return value;
  const double quantum = std::ldexp(1.0, std::ilogb(largest) - 36);
  return std::nearbyint(value / quantum) * quantum;
}

/// From the solid; 0 inside it.
double CoveredBy::distanceTo(int copy, Vec2 p) const {
  const Vec2 at = p - copies[copy].shift;
  double nearest = 1e300;
  bool inside = false;
  for (const Outline& outline : solids[copies[copy].solid].outlines)
    for (std::size_t k = 0; k < outline.size(); ++k) {
      const Vec2 a = outline[k] - at, along = outline[k + 1 < outline.size() ? k + 1 : 0] - outline[k];
      const double size = dot(along, along), t = size > 0 ? std::clamp(-dot(a, along) / size, 0.0, 1.0) : 0;
      const Vec2 away = a + t * along;
      nearest = std::min(nearest, dot(away, away));
      if ((a.y > 0) != (a.y + along.y > 0) && a.x - a.y / along.y * along.x > 0) inside = !inside;
    }
  return inside ? 0 : std::sqrt(nearest);
}

CoveredBy::Surface CoveredBy::meanOfGroup(int label, Vec2 p) const {
  double nearest = 1e300;
  const auto eachWithin = [&](auto&& body) {
    mixed.near(label, p, [&](int copy) {
      const double* box = &geometry.work.boxes[4 * copy];
      const double reach = nearest + kNear * grid.h;
      if (p.x < box[0] - reach || p.x > box[2] + reach || p.y < box[1] - reach || p.y > box[3] + reach)
        return;
      const double distance = distanceTo(copy, p);
      if (distance <= reach) body(copy, distance);
    });
  };
  eachWithin([&](int, double distance) { nearest = std::min(nearest, distance); });
  Mean mean(*this, p);
  if (nearest == 1e300)
    mean.add(label);
  else
    eachWithin([&](int copy, double) { mean.add(copy); });
  return mean.result();
}

CoveredBy::Surface CoveredBy::at(int label, Vec2 p) const {
  if (mixed.has(label)) return meanOfGroup(label, p);
  Mean mean(*this, p);
  mean.add(label);
  return mean.result();
}

CoveredBy::Surface CoveredBy::mean(const Surface& a, const Surface& b) {
  return {0.5 * (a.velocity + b.velocity), 0.5 * (a.drag + b.drag), a.solid};
}

CoveredBy::Surface CoveredBy::at(int label, int other, Vec2 p) const {
  const Surface surface = at(label, p);
  if (label == other || (mixed.has(label) && mixed.together(label, other))) return surface;
  return mean(surface, at(other, p));
}

CoveredBy::Surface CoveredBy::at(const ShutPart& part) const {
  const double across = (part.xFace ? part.i : part.j) * grid.h, middle = 0.5 * (part.lo + part.hi);
  const Vec2 p = part.xFace ? Vec2{across, middle} : Vec2{middle, across};
  const Vec2 end = p + (part.xFace ? Vec2{grid.width(), 0} : Vec2{0, grid.height()});
  if (part.solidAtEnd == part.otherAtEnd) return at(part.solid, part.other, part.solidAtEnd ? end : p);
  return mean(at(part.solid, part.solidAtEnd ? end : p), at(part.other, part.otherAtEnd ? end : p));
}

}  // namespace smokebox

// Polygons at random for tests of bodies, the same on every machine.
#pragma once
#include <cstdint>

#include "support/rigid_world.h"

namespace smokebox::test {

class Dice {
 public:
  explicit Dice(std::uint64_t seed) : state_(seed * 2654435761u + 1) {}
  double between(double lo, double hi) {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return lo + (hi - lo) * static_cast<double>(state_ >> 11) * 0x1p-53;
  }

 private:
  std::uint64_t state_;
};

/// Star-shaped, with 3 to 8 corners (concave: 6 to 10, every second drawn in), of a size within `radius`.
inline std::shared_ptr<const BodyShape> randomPolygon(Dice& dice, bool concave, double radius = 0.6) {
  const int corners =
      concave ? 2 * static_cast<int>(dice.between(3, 6)) : static_cast<int>(dice.between(3, 9));
  PolygonShape polygon;
  for (int k = 0; k < corners; ++k) {
    const double angle = 2 * kPi * (k + (concave ? 0 : dice.between(-0.3, 0.3))) / corners;
    const double r = radius * (concave && k % 2 == 0 ? dice.between(0.35, 0.5) : dice.between(0.9, 1));
    polygon.points.push_back({r * exact::cos(angle), r * exact::sin(angle)});
  }
  return bodyShape(polygon);
}

}  // namespace smokebox::test

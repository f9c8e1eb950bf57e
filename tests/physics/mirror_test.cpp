// A mirrored problem has the mirrored pressure.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "world/world.h"

namespace smokebox {
namespace {

TEST(Mirror, IsMirroredToTheBitBetweenLeftAndRight) {
  // Truth: u(x) = -u(-x), v and phi the same on both sides, after 40 steps of a stirred, confined, viscous
  // flow against a disk on the axis: not a bit differs, though no iteration is exact.
  const int n = 64;
  World world(SceneDocument::parse(R"yaml(
domain: {size: [1, 1.25], resolution: 64}
walls: {top: open, left: no-slip, right: no-slip}
fluid:
  viscosity: 1e-4
  vorticity: 0.3
  velocity: ["(x - 0.5)*sin(9*y)", "cos(5*(x - 0.5))*sin(3*y)"]
solids: [{name: disk, shape: {circle: {radius: 0.12}}, position: [0.5, 0.8]}]
output: {fps: 1}
time: {duration: 1, step: 1/100}
)yaml",
                                   "mirror.yaml"),
              {});
  for (int k = 0; k < 40; ++k) world.step();
  const Fluid& fluid = *world.fluid();
  double speed = 0;
  long unlike = 0;
  for (int j = 0; j < 80; ++j)
    for (int i = 0; i < n; ++i) {
      speed = std::max<double>(speed, std::abs(fluid.v()(i, j)));
      unlike += fluid.u()(i, j) != -fluid.u()(n - i, j);
      unlike += fluid.v()(i, j) != fluid.v()(n - 1 - i, j);
      unlike += fluid.phi()(i, j) != fluid.phi()(n - 1 - i, j);
    }
  EXPECT_GT(speed, 0.2);
  EXPECT_EQ(unlike, 0);
}

}  // namespace
}  // namespace smokebox

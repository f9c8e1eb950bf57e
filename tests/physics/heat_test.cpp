// Temperature: what is carried, diffused and kept, against exact answers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/maths.h"
#include "study/study.h"
#include "world/plan.h"
#include "world/ranges.h"
#include "world/world.h"

namespace smokebox {
namespace {

World worldOf(const std::string& yaml, int threads = 1) {
  return World(SceneDocument::parse(yaml, "heat.yaml"), {.threads = threads, .figures = true});
}

void run(World& world, long steps) {
  for (long k = 0; k < steps; ++k) world.step();
}

double largestSpeed(const World& world) {
  const Grid& grid = world.boundary().grid;
  double largest = 0;
  for (int j = 0; j <= grid.ny; ++j)
    for (int i = 0; i <= grid.nx; ++i)
      largest = std::max<double>(
          {largest, std::fabs(world.fluid()->u()(i, j)), std::fabs(world.fluid()->v()(i, j))});
  return largest;
}

struct Extremes {
  double low = 1e300, high = -1e300, sum = 0;
};
/// Over the open cells; the sum is of what the cells hold: at least half a cell each.
Extremes extremesOf(const World& world) {
  const Grid& grid = world.boundary().grid;
  Extremes e;
  for (int j = 0; j < grid.ny; ++j)
    for (int i = 0; i < grid.nx; ++i) {
      if (!world.heat()->isOpen(i, j)) continue;
      const double t = world.heat()->at(i, j);
      e.low = std::min(e.low, t);
      e.high = std::max(e.high, t);
      e.sum += t * std::clamp<double>(world.boundary().volume(i, j), 0.5, 1);
    }
  return e;
}

TEST(Heat, IsNotModelledUnlessNamed) {
  // Truth: without the key there is no field, no stage and no memory; with it there is what is asked for.
  const std::string box = "domain: {size: [1, 1], resolution: 32}\nfluid: {}\n";
  World without = worldOf(box);
  EXPECT_EQ(without.heat(), nullptr);
  World carried = worldOf(box + "temperature: {start: x}\n"),
        diffused = worldOf(box + "temperature: {start: x, diffusivity: 1e-3}\n");
  EXPECT_GT(carried.bytes(), without.bytes());
  EXPECT_GT(diffused.bytes(), carried.bytes());
  auto modelled = [](const std::string& scene, const std::string& stage) {
    for (const PlanLine& line : planOf(SceneDocument::parse(scene, "t").spec()).lines)
      if (line.stage == stage) return line.modelled;
    ADD_FAILURE() << stage;
    return false;
  };
  EXPECT_FALSE(modelled(box, "temperature"));
  EXPECT_TRUE(modelled(box + "temperature: {}\n", "temperature"));
  EXPECT_FALSE(modelled(box + "temperature: {}\n", "diffusion of heat"));
  EXPECT_FALSE(modelled(box + "temperature: {}\n", "buoyancy of heat"));
  EXPECT_TRUE(modelled(box + "gravity: [0, -9.81]\ntemperature: {}\n", "buoyancy of heat"));
}

TEST(Heat, AUniformTemperatureStaysExactlyAndMovesNothing) {
  // Truth: 293.15 everywhere, whatever the solid does; a fluid at rest stays at rest.
  const std::string scene = R"yaml(
domain: {size: [1, 1], resolution: 48}
walls: {left: open, right: no-slip, bottom: no-slip, top: open}
gravity: [0, -9.81]
fluid: {viscosity: 1e-3}
temperature: {start: 293.15, diffusivity: 1e-3}
output: {fps: 1}
time: {duration: 100, step: 1/50}
solids: [{name: disk, shape: {circle: {radius: 0.17}}, position: [0.41, 0.53])yaml";
  World rest = worldOf(scene + "}]\n");
  run(rest, 50);
  EXPECT_EQ(largestSpeed(rest), 0);
  World stirred = worldOf(scene + ", motion: {expression: {x: \"0.45 + 0.2*sin(3*t)\"}}}]\n");
  run(stirred, 50);
  EXPECT_GT(largestSpeed(stirred), 0.3);
  EXPECT_EQ(extremesOf(stirred).low, 293.15);
  EXPECT_EQ(extremesOf(stirred).high, 293.15);
}

TEST(Heat, LayersOfFluidStayAtRest) {
  // Truth: warm above cold is in balance; the pressure carries it, to its tolerance.
  World world = worldOf(R"yaml(
domain: {size: [1, 1], resolution: 64}
gravity: [0, -9.81]
fluid: {}
temperature: {start: "20 + 30*y"}
output: {fps: 1}
time: {duration: 100, step: 1/100}
solids: [{name: disk, shape: {circle: {radius: 0.17}}, position: [0.41, 0.53]}]
)yaml");
  run(world, 100);
  EXPECT_LT(largestSpeed(world) / std::sqrt(9.81), 1e-4);
}

TEST(Heat, BetweenTwoWallsItIsAStraightLine) {
  // Truth: 1 on the left, 3 on the right, in the end linear between them, in steps of 100 h^2 / diffusivity
  // too.
  World world = worldOf(R"yaml(
domain: {size: [1, 0.5], resolution: 32}
fluid: {}
temperature: {diffusivity: 0.1, start: 7, walls: {left: 1, right: 3}}
output: {fps: 1}
time: {duration: 100, step: 1}
)yaml");
  run(world, 100);
  double error = 0;
  for (int j = 0; j < 16; ++j)
    for (int i = 0; i < 32; ++i)
      error = std::max(error, std::fabs(world.heat()->at(i, j) - (1 + 2 * (i + 0.5) / 32)));
  EXPECT_LT(error, 1e-4);
}

TEST(Heat, AWaveDecaysAtItsRate) {
  // Truth: cos(2 pi x) between insulated walls falls by exp(-diffusivity (2 pi)^2 t). Against walls that keep
  // 0, sin(pi x) falls by exp(-diffusivity pi^2 t): second order there too.
  auto amplitudeError = [](const std::string& start, const std::string& walls, double k, int cells) {
    World world = worldOf("domain: {size: [1, 0.5], resolution: " + std::to_string(cells) +
                          "}\nfluid: {}\noutput: {fps: 1}\ntime: {duration: 1, step: 1/4000}\n"
                          "temperature: {diffusivity: 0.1, start: \"" +
                          start + "\"" + walls + "}\n");
    run(world, 1000);
    const double mean = world.heat()->at(cells / 4 - 1, 3) + world.heat()->at(cells / 4, 3);
    const double before = 0.5 * mean;
    const double x1 = (cells / 4 - 0.5) / cells, x2 = (cells / 4 + 0.5) / cells;
    auto wave = [&](double x) { return walls.empty() ? std::cos(k * x) : std::sin(k * x); };
    // At the middle of the slope of the cosine its value is 0: compare at the first cell instead.
    if (walls.empty())
      return std::fabs(world.heat()->at(0, 3) - wave(0.5 / cells) * std::exp(-0.1 * k * k * 0.25));
    return std::fabs(before - 0.5 * (wave(x1) + wave(x2)) * std::exp(-0.1 * k * k * 0.25));
  };
  EXPECT_LT(amplitudeError("cos(2*pi*x)", "", 2 * kPi, 64), 5e-4);
  const double coarse = amplitudeError("sin(pi*x)", ", walls: {left: 0, right: 0}", kPi, 16),
               fine = amplitudeError("sin(pi*x)", ", walls: {left: 0, right: 0}", kPi, 32);
  std::printf("wave between walls: %.2e, %.2e\n", coarse, fine);
  EXPECT_LT(fine, 1e-3);
  EXPECT_LT(fine, coarse / 3);
}

TEST(Heat, WhatIsCarriedAroundStaysBetweenItsExtremesAndKeepsItsSum) {
  // Truth: a sharp square of 5 in 1, stirred around a disk in a closed box: never below 1 nor above 5, and
  // the sum over the cells is kept.
  const std::string scene = R"yaml(
domain: {size: [1, 1], resolution: 64}
fluid: {velocity: ["-sin(pi*x)*cos(pi*y)", "cos(pi*x)*sin(pi*y)"]}
temperature: {start: "x > 0.2 && x < 0.4 && y > 0.4 && y < 0.7 ? 5 : 1"}
output: {fps: 1}
time: {duration: 100, step: 1/40}
solids: [{name: disk, shape: {circle: {radius: 0.13}}, position: [0.57, 0.55]}]
)yaml";
  World world = worldOf(scene);
  const Extremes before = extremesOf(world);
  run(world, 200);
  const Extremes after = extremesOf(world);
  EXPECT_GT(after.low, 1 - 1e-4);
  EXPECT_LT(after.high, 5 + 1e-4);
  EXPECT_GT(after.high, 3);
  // What the pressure leaves of the divergence is all that changes it.
  EXPECT_NEAR(after.sum / before.sum, 1, 2e-5);
}

TEST(Heat, ASmoothFieldIsCarriedWithSecondOrderOrMore) {
  // Truth: exp(cos) drifts with the fluid across a periodic box and comes back after 1 s.
  std::vector<double> errors;
  for (const int cells : {32, 64, 128}) {
    World world = worldOf("domain: {size: [1, 1], resolution: " + std::to_string(cells) +
                          R"yaml(}
walls: {left: periodic, right: periodic, bottom: periodic, top: periodic}
fluid: {velocity: [1, 1]}
temperature: {start: "exp(cos(2*pi*x) + sin(2*pi*y))"}
output: {fps: 1}
time: {duration: 1, step: 1/)yaml" +
                          std::to_string(3 * cells) + "}\n");
    run(world, 3 * cells);
    double error = 0;
    for (int j = 0; j < cells; ++j)
      for (int i = 0; i < cells; ++i) {
        const Vec2 p = world.boundary().grid.cellCentre(i, j);
        const double exact = std::exp(std::cos(2 * kPi * p.x) + std::sin(2 * kPi * p.y));
        error = std::max(error, std::fabs(world.heat()->at(i, j) - exact));
      }
    std::printf("carried over %d cells: %.2e of 7.4\n", cells, error);
    errors.push_back(error);
  }
  EXPECT_LT(errors.back(), 2e-3);
  EXPECT_GT(fittedOrder({32, 64, 128}, errors), 2);
}

TEST(Heat, InflowBringsWhatItsSideSays) {
  // Truth: 30 degrees come in, and after two passages that is all there is; without a word of it the start's.
  auto probe = [](const std::string& walls) {
    World world = worldOf(R"yaml(
domain: {size: [2, 1], resolution: 32}
walls: {left: {inflow: [1, 0]}, right: open}
fluid: {velocity: [1, 0]}
probes: [{name: p, at: [1.5, 0.5]}, {name: all, region: {box: {size: [1, 1]}, position: [1, 0.5]}}]
output: {fps: 1}
time: {duration: 100, step: 1/40}
temperature: {start: 20)yaml" +
                          walls + "}\n");
    EXPECT_NEAR(world.figures().probes[0].temperature, 20, 1e-6);
    run(world, 160);
    EXPECT_NEAR(world.figures().probes[1].temperature, world.figures().probes[0].temperature, 1e-3);
    return world.figures().probes[0].temperature;
  };
  EXPECT_NEAR(probe(", walls: {left: 30}"), 30, 1e-3);
  EXPECT_NEAR(probe(""), 20, 1e-6);
}

TEST(Heat, EventsSetWallsExpansionAndDiffusivity) {
  // Truth: a wall that an event heats warms the fluid from then on, and one set back to nothing else cools
  // it.
  World world = worldOf(R"yaml(
domain: {size: [1, 1], resolution: 16}
fluid: {}
temperature: {diffusivity: 0, start: 5, walls: {left: 5}}
output: {fps: 1}
time: {duration: 100, step: 1/10}
events:
  - {at: 1, set: {temperature.walls.left: "5 + t"}}
  - {at: 2, set: {temperature.diffusivity: 0.5}}
)yaml");
  run(world, 20);
  EXPECT_EQ(world.heat()->at(0, 8), 5);
  run(world, 50);
  EXPECT_GT(world.heat()->at(0, 8), 10);
  EXPECT_LT(world.heat()->at(0, 8), 12);
}

const std::string kStirred = R"yaml(
domain: {size: [1, 1.5], resolution: 64}
walls: {left: no-slip, right: no-slip, bottom: no-slip, top: open}
gravity: [0, -9.81]
fluid: {viscosity: 1e-4}
temperature: {diffusivity: 1e-4, start: 20, walls: {bottom: "x > 0.3 && x < 0.7 ? 120 : 20"}}
output: {fps: 1}
time: {duration: 100, step: 1/60}
solids: [{name: bar, shape: {box: {size: [0.5, 0.06]}}, position: [0.5, 0.6], motion: {spin: 120}}]
)yaml";

TEST(Heat, IsTheSameForOneAndTwoThreads) {
  // Truth: the same state to the bit, and it counts the temperature.
  World one = worldOf(kStirred), two = worldOf(kStirred, 2);
  run(one, 60);
  run(two, 60);
  EXPECT_GT(largestSpeed(one), 0.2);
  EXPECT_EQ(one.stateHash(), two.stateHash());
  World warm = worldOf("domain: {size: [1, 1], resolution: 16}\ntemperature: {start: y}\n"),
        cold = worldOf("domain: {size: [1, 1], resolution: 16}\ntemperature: {start: 2*y}\n");
  EXPECT_NE(warm.stateHash(), cold.stateHash());
}

TEST(Heat, AStirrerKeepsTheTemperatureBetweenItsExtremes) {
  // Truth: between the coldest and the hottest that any wall has, while a bar turns through it.
  World world = worldOf(kStirred);
  run(world, 200);
  EXPECT_GT(extremesOf(world).low, 20 - 0.1);
  EXPECT_LT(extremesOf(world).high, 120 + 0.1);
  EXPECT_GT(extremesOf(world).high, 60);
}

TEST(Heat, AHugeStepStaysBounded) {
  // Truth: at many cells a step the temperature stays within its extremes too.
  World world = worldOf(R"yaml(
domain: {size: [1, 1], resolution: 64}
walls: {left: periodic, right: periodic}
fluid: {velocity: [40, 0]}
temperature: {start: "x < 0.5 ? 0 : 1", diffusivity: 1}
output: {fps: 1}
time: {duration: 10, step: 1/10}
)yaml");
  run(world, 10);
  EXPECT_GT(extremesOf(world).low, -1e-3);
  EXPECT_LT(extremesOf(world).high, 1 + 1e-3);
}

TEST(Heat, TheRangeOfTheLayerIsThatOfTheFilm) {
  // Truth: from the cold to the hot wall, in round numbers.
  const FilmRanges ranges = findRanges(SceneDocument::parse(R"yaml(
domain: {size: [1, 1], resolution: 32}
fluid: {}
temperature: {diffusivity: 0.5, start: 20, walls: {left: 20, right: 24}}
view: {layers: [temperature]}
output: {fps: 10}
time: {duration: 5, step: 1/10}
)yaml",
                                                            "t"),
                                       1);
  EXPECT_NEAR(ranges.temperature[0], 20, 1e-6);
  EXPECT_NEAR(ranges.temperature[1], 24, 1e-6);
}

}  // namespace
}  // namespace smokebox

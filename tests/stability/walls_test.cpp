// Every pair of walls, every viscosity.
#include "stable_run.h"

namespace smokebox {
namespace {

using test::runStably;
using test::StableRun;

class WallPair : public testing::TestWithParam<std::tuple<std::string, std::string, bool>> {};

/// What is given for the left side, turned to the bottom if `upright`.
std::string wall(const std::string& kind, bool upright, bool inwards) {
  if (kind == "inflow") {
    const char* sign = inwards ? "0.5" : "-0.5";
    return std::string("{inflow: ") + (upright ? "[0, " : "[") + sign + (upright ? "]}" : ", 0]}");
  }
  if (kind == "moving") return upright ? "{no-slip: [0.5, 0]}" : "{no-slip: [0, 0.5]}";
  return kind;
}

TEST_P(WallPair, AStirredFluidStaysBoundedBetweenThem) {
  // Truth: finite, divergence below the tolerance, smoke conserved; energy below that of what drives it.
  const auto& [first, second, upright] = GetParam();
  // Two inflows against each other, or one against a wall, can only be driven out through an open side.
  const bool driven = first == "inflow" || second == "inflow";
  const std::string other = driven ? "open" : "slip";
  const std::string walls =
      upright ? "walls: {bottom: " + wall(first, true, true) + ", top: " + wall(second, true, false) +
                    ", left: " + other + ", right: " + other + "}"
              : "walls: {left: " + wall(first, false, true) + ", right: " + wall(second, false, false) +
                    ", bottom: " + other + ", top: " + other + "}";
  for (const double viscosity : {0.0, 1e-3}) {
    const std::string scene = "domain: {size: [1, 1], resolution: 48}\n" + walls +
                              "\nfluid: {density: 1, viscosity: " + std::to_string(viscosity) + R"yaml(}
smoke: {sources: [{shape: {circle: {center: [0.5, 0.5], radius: 0.15}}, rate: 1}]}
events: [{at: 0, force: {circle: {center: [0.4, 0.5], radius: 0.2}, acceleration: [2, 3], for: 0.5}}]
time: {duration: 1000, step: 1/60}
output: {fps: 1}
)yaml";
    runStably(scene, 90, 5);
  }
}

std::vector<std::tuple<std::string, std::string, bool>> wallPairs() {
  const std::vector<std::string> kinds = {"slip", "no-slip", "open", "inflow", "moving"};
  std::vector<std::tuple<std::string, std::string, bool>> pairs;
  for (const bool upright : {false, true}) {
    for (const std::string& a : kinds)
      for (const std::string& b : kinds) pairs.emplace_back(a, b, upright);
    pairs.emplace_back("periodic", "periodic", upright);
  }
  return pairs;
}

INSTANTIATE_TEST_SUITE_P(All, WallPair, testing::ValuesIn(wallPairs()));

class Thick : public testing::TestWithParam<double> {};

TEST_P(Thick, AnyViscosityOnlySlowsDown) {
  // Truth: in a box of no-slip walls the energy falls, the faster the more viscous, and never grows.
  char text[40];
  std::snprintf(text, sizeof text, "%g", GetParam());
  const std::string scene = R"yaml(domain: {size: [1, 1], resolution: 48}
walls: {left: no-slip, right: no-slip, bottom: no-slip, top: no-slip}
solids: [{name: disk, shape: {circle: {radius: 0.12}}, position: [0.41, 0.5]}]
time: {duration: 1000, step: 1/60}
output: {fps: 1}
fluid: {density: 1, velocity: ["sin(2*pi*x)*cos(2*pi*y)", "-cos(2*pi*x)*sin(2*pi*y)"], viscosity: )yaml" +
                            std::string(text) + "}\n";
  const StableRun run = runStably(scene, 60, 0.26);
  // The slowest mode of a box decays at least as fast as exp(-2 nu 2 pi^2 t).
  EXPECT_LT(run.energyEnd, 0.26 * std::exp(-4 * 9.87 * GetParam() * 1.0) + 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Viscosity, Thick,
                         testing::Values(0.0, 1e-6, 1e-3, 1e-2, 0.1, 1.0, 10.0, 1000.0, 1e6));

}  // namespace
}  // namespace smokebox

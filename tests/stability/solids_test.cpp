// Solids where they are awkward: against walls and one another, over sources, everywhere, gone and back, too
// fast, and shutting pockets.
#include "stable_run.h"

namespace smokebox {
namespace {

using test::runStably;
using test::StableRun;

/// A box of 1 m with smoke that a breeze carries; `solids` is the list that follows.
std::string box(const std::string& solids, const std::string& more = "", int stepsASecond = 60,
                const std::string& walls = "walls: {left: {inflow: [0.5, 0]}, right: open}") {
  return "domain: {size: [1, 1], resolution: 48}\n" + walls + R"(
fluid: {density: 1, vorticity: 0.2, velocity: ["0.5", "0"]}
smoke:
  sources: [{shape: {circle: {center: [0.3, 0.5], radius: 0.1}}, rate: 1}]
output: {fps: 1}
)" + "time: {duration: 1000, step: 1/" +
         std::to_string(stepsASecond) + "}\n" + more + "solids:\n" + solids;
}

constexpr const char* kClosed = "walls: {}";

TEST(AwkwardSolids, TouchWallsAndOneAnother) {
  // Truth: bodies that lie on a wall, in a corner, across a side, edge to edge, corner to corner and over one
  // another are covered like any other.
  runStably(box(R"(  - {name: on the floor, shape: {box: {size: [0.2, 0.1]}}, position: [0.3, 0.05]}
  - {name: beside it, shape: {box: {size: [0.2, 0.1]}}, position: [0.5, 0.05]}
  - {name: on the edge, shape: {box: {size: [0.1, 0.1]}}, position: [0.65, 0.15]}
  - {name: corner, shape: {box: {size: [0.2, 0.2]}}, position: [0.95, 0.95], angle: 45}
  - {name: half outside, shape: {circle: {radius: 0.1}}, position: [0.5, 1.03]}
  - {name: over it, shape: {circle: {radius: 0.08}}, position: [0.56, 0.9], drag: 1}
  - {name: kissing, shape: {circle: {radius: 0.08}}, position: [0.72, 0.9]}
)"),
            100, 4);
}

TEST(AwkwardSolids, CoverASource) {
  // Truth: a source inside a solid gives nothing; one that a solid comes over stops, and its smoke is not
  // lost.
  runStably(box("  - {name: lid, shape: {circle: {radius: 0.2}}, position: [0.3, 0.5]}\n"), 60, 4);
  runStably(box("  - {name: lid, shape: {circle: {radius: 0.18}}, motion: {keyframes: [{at: 0, position: "
                "[0.8, 0.5]}, {at: 1, position: [0.3, 0.5]}, {at: 2, position: [0.8, 0.5]}]}}\n"),
            130, 4);
}

TEST(AwkwardSolids, FillTheDomain) {
  // Truth: with no fluid left, or next to none, there is nothing to solve and nothing to fail.
  runStably(
      box("  - {name: block, shape: {box: {size: [1.2, 1.2]}}, position: [0.5, 0.5]}\n", "", 60, kClosed), 20,
      1);
  runStably(
      box("  - {name: block, shape: {box: {size: [0.999, 0.999]}}, position: [0.5, 0.5]}\n", "", 60, kClosed),
      20, 1);
  runStably(box("  - {name: press, shape: {box: {size: [1.2, 1.2]}}, motion: {keyframes: [{at: 0, position: "
                "[-0.4, 0.5]}, {at: 1, position: [0.5, 0.5]}, {at: 2, position: [-0.4, 0.5]}]}}\n"),
            130, 50);
}

TEST(AwkwardSolids, LeaveTheDomainAndComeBack) {
  // Truth: a body that goes out through any side and comes in through another is no different from one that
  // never left.
  runStably(
      box("  - {name: visitor, shape: {box: {size: [0.2, 0.2]}}, angle: 20, motion: {keyframes: [{at: 0, "
          "position: [0.5, 0.5]}, {at: 0.7, position: [1.6, 0.7]}, {at: 0.8, position: [-0.6, 0.3]}, "
          "{at: 1.6, position: [0.5, -0.4]}, {at: 2, position: [0.5, 0.5], angle: 200}]}}\n"),
      140, 250);
  runStably(
      box("  - {name: visitor, shape: {circle: {radius: 0.1}}, position: [0.5, 0.5], motion: {velocity: "
          "[0.9, 0.7]}}\n",
          "", 60, "walls: {left: periodic, right: periodic, bottom: periodic, top: periodic}"),
      150, 10);
}

class Fast : public testing::TestWithParam<double> {};

TEST_P(Fast, SolidsMoveManyCellsAStep) {
  // Truth: a blade and a block that move up to dozens of cells in a step neither lose smoke nor blow up.
  const std::string speed = std::to_string(GetParam() / 48 * 60);  // cells a step, of 1/48 m and 1/60 s
  const std::string spin = std::to_string(GetParam() / 48 * 60 / 0.3 * 57.3);
  const double energy = 5 + 5 * std::pow(GetParam() / 48 * 60, 2.0);
  runStably(
      box("  - {name: blade, shape: {box: {size: [0.6, 0.05]}}, position: [0.5, 0.5], motion: {velocity: "
          "[0, 0], spin: " +
          spin + "}}\n"),
      60, energy);
  runStably(box("  - {name: block, shape: {box: {size: [0.15, 0.15]}}, motion: {expression: {x: \"0.5 + "
                "0.3*sin(" +
                speed + "/0.3*t)\", y: \"0.5\", angle: \"0\"}}}\n"),
            60, energy);
}

INSTANTIATE_TEST_SUITE_P(CellsAStep, Fast, testing::Values(0.3, 1.0, 3.0, 10.0, 30.0));

TEST(AwkwardSolids, ShutAPocketAndSqueezeIt) {
  // Truth: a piston that closes a cylinder and goes on has nowhere to push the fluid to: the change of volume
  // is spread over the pocket and reported, the smoke stays in it.
  const StableRun run =
      runStably(box(R"(  - {name: left wall, shape: {box: {size: [0.1, 0.6]}}, position: [0.25, 0.3]}
  - {name: right wall, shape: {box: {size: [0.1, 0.6]}}, position: [0.75, 0.3]}
  - {name: piston, shape: {box: {size: [0.5, 0.1]}}, motion: {keyframes: [{at: 0, position: [0.5, 0.9]}, {at: 1, position: [0.5, 0.6]}, {at: 2, position: [0.5, 0.3]}, {at: 3, position: [0.5, 0.9]}]}}
)",
                    "", 60),
                200, 10);
  EXPECT_GT(run.compressionMost, 0.1);
}

class Gap : public testing::TestWithParam<int> {};

TEST_P(Gap, ThatClosesAndOpensDoesNoHarm) {
  // Truth: what is squeezed out between blocks that meet face to face across a periodic side, or out of the
  // cusp of two disks, is hundreds of times faster than they are, and remains a number.
  const auto scene = [](const std::string& walls, const std::string& shape, double from, double by,
                        double along) {
    std::string text = "domain: {size: [1, 80/75], resolution: 75}\nwalls: " + walls +
                       "\nfluid: {viscosity: 1e-4, vorticity: 0.3}\nsmoke: {buoyancy: 2, sources: [{shape: "
                       "{circle: {center: [0.5, 0.25], radius: 0.1}}, rate: 8, velocity: [0, 0.5]}]}\n"
                       "output: {fps: 1}\ntime: {duration: 10, step: 1/" +
                       std::to_string(GetParam()) + "}\nsolids:\n";
    for (const int side : {-1, 1})
      text += "  - {name: s" + std::to_string(1 + side) + ", shape: " + shape +
              ", motion: {expression: {x: \"0.5+(" + std::to_string(side) + ")*(" + std::to_string(from) +
              "+" + std::to_string(by) + "*sin(4*t))\", y: \"0.7+" + std::to_string(along) +
              "*sin(3*t)\", angle: \"0\"}}}\n";
    return text;
  };
  runStably(scene("{left: periodic, right: periodic}", "{box: {size: [0.15, 0.2]}}", 0.3, 0.3, 0),
            GetParam());
  runStably(scene("{left: no-slip, right: no-slip, top: open}", "{circle: {radius: 0.12}}", 0.1, 0.12, 0.1),
            GetParam());
}

INSTANTIATE_TEST_SUITE_P(StepsASecond, Gap, testing::Values(90, 100, 110, 150));

TEST(AwkwardSolids, ThinWallsAndSliversShutPocketsAtAnyAngle) {
  // Truth: boxes of bars thinner than a cell, turned and overlapping, some moving.
  std::string solids;
  for (int k = 0; k < 12; ++k) {
    const std::string name = std::to_string(k), x = std::to_string(0.15 + 0.07 * k),
                      y = std::to_string(0.2 + 0.05 * (k % 7)), angle = std::to_string(31 * k);
    solids += "  - {name: b" + name + ", shape: {box: {size: [0.5, 0.008]}}, position: [" + x + ", " + y +
              "], angle: " + angle + (k % 3 == 0 ? ", motion: {velocity: [0.05, 0.03], spin: 20}}\n" : "}\n");
  }
  runStably(box(solids), 100, 10);
}

TEST(AwkwardSolids, FortyOfAllSizes) {
  // Truth: a crowd from slivers to boulders, some larger than the gaps between them.
  std::string solids;
  for (int k = 0; k < 40; ++k) {
    const double radius = 0.004 * std::pow(1.09, k);
    solids += "  - {name: s" + std::to_string(k) + ", shape: {regular: {sides: " + std::to_string(3 + k % 5) +
              ", radius: " + std::to_string(radius) + "}}, position: [" +
              std::to_string(std::fmod(0.61803 * k, 1.0)) + ", " +
              std::to_string(std::fmod(0.41421 * k, 1.0)) + "], angle: " + std::to_string(17 * k) + "}\n";
  }
  runStably(box(solids), 60, 10);
}

}  // namespace
}  // namespace smokebox

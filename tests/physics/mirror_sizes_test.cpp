// A mirrored problem has the mirrored solution at any number of cells: odd ones, where the axis runs through
// the middle of cells, and those whose halves, quarters .. are odd; whatever stands or moves on the axis or
// beside it, and across periodic sides.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "world/world.h"

namespace smokebox {
namespace {

struct Obstacle {
  const char* shape;  // as upright
  double across, along, angle = 0, spin = 0;
  // Expressions in t, added to the place: away from the axis, and along it.
  const char *moves = nullptr, *rises = "0";
};

/// A plume of smoke against what stands on the axis, or in pairs beside it. Lengths are for a box of width 1.
struct Case {
  const char* name;
  int across, along;  // cells
  std::vector<Obstacle> obstacles;
  const char *sides = "no-slip", *end = "open";  // walls along the axis, and where the plume goes to
  const char* step = "1/100";
  bool free = false;  // bodies, not solids
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.name << ' ' << c.across << " x " << c.along; }

/// Upright: the axis is x = 1/2. Aside: the same with x and y exchanged.
std::string sceneOf(const Case& c, bool upright) {
  const auto pair = [&](double across, double along) {
    const std::string a = std::to_string(across), b = std::to_string(along);
    return upright ? "[" + a + ", " + b + "]" : "[" + b + ", " + a + "]";
  };
  const std::string n = std::to_string(c.across), m = std::to_string(c.along);
  const std::string length = m + "/" + n, left = upright ? "left" : "bottom",
                    right = upright ? "right" : "top", end = upright ? "top" : "right";
  std::string scene = "domain: {size: " + (upright ? "[1, " + length + "]" : "[" + length + ", 1]") +
                      ", resolution: " + (upright ? n : m) + "}\n";
  scene +=
      "walls: {" + left + ": " + c.sides + ", " + right + ": " + c.sides + ", " + end + ": " + c.end + "}\n";
  scene += "gravity: " + pair(0, -9.81) + "\nfluid: {viscosity: 1e-4, vorticity: 0.3}\n";
  scene += "smoke: {buoyancy: 2, sources: [{shape: {circle: {center: " + pair(0.5, 0.25) +
           ", radius: 0.1}}, rate: 8, velocity: " + pair(0, 0.5) + "}]}\n";
  scene += c.free ? "bodies:\n" : "solids:\n";
  for (const Obstacle& o : c.obstacles)
    for (int side = o.across == 0 ? 1 : -1; side <= 1; side += 2) {
      const int turn = upright ? side : -side;
      const double angle = upright ? side * o.angle : 90 - side * o.angle;
      scene += "  - {shape: " + std::string(o.shape) + ", position: " + pair(0.5 + side * o.across, o.along) +
               ", angle: " + std::to_string(angle);
      if (o.spin != 0 && !c.free) scene += ", motion: {spin: " + std::to_string(turn * o.spin) + "}";
      if (o.spin != 0 && c.free) scene += ", spin: " + std::to_string(turn * o.spin);
      if (c.free) scene += ", ignore: all";  // and overlap
      if (o.moves) {
        const std::string across = std::to_string(0.5 + side * o.across) + "+(" + std::to_string(side) +
                                   ")*(" + o.moves + ")",
                          along = std::to_string(o.along) + "+" + o.rises;
        scene += std::string(", motion: {expression: {") + (upright ? "x" : "y") + ": \"" + across + "\", " +
                 (upright ? "y" : "x") + ": \"" + along + "\"}}";
      }
      scene += "}\n";
    }
  return scene + "output: {fps: 1}\ntime: {duration: 10, step: " + c.step + "}\n";
}

struct Asymmetry {
  long values = 0;                               // that differ from those in the mirror
  double velocity = 0, pressure = 0, smoke = 0;  // the largest difference, by the largest value
  double speed = 0, densest = 0;
};

Asymmetry asymmetryAfter(int steps, const std::string& scene, bool leftRight) {
  World world(SceneDocument::parse(scene, "mirror.yaml"), {.threads = 1});
  for (int k = 0; k < steps; ++k) world.step();
  const Fluid& fluid = *world.fluid();
  const Field& smoke = world.smoke()->smoke().value(0);
  const int nx = world.boundary().grid.nx, ny = world.boundary().grid.ny;
  Asymmetry result;
  double highest = 0;
  const auto compare = [&](float a, float b, double& largest, double& off) {
    result.values += a != b;
    largest = std::max<double>(largest, std::fabs(a));
    off = std::max<double>(off, std::fabs(a - b));
  };
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const int x = leftRight ? nx - 1 - i : i, y = leftRight ? j : ny - 1 - j;
      compare(fluid.u()(i, j), leftRight ? -fluid.u()(nx - i, j) : fluid.u()(i, y), result.speed,
              result.velocity);
      compare(fluid.v()(i, j), leftRight ? fluid.v()(x, j) : -fluid.v()(i, ny - j), result.speed,
              result.velocity);
      compare(fluid.phi()(i, j), fluid.phi()(x, y), highest, result.pressure);
      compare(smoke(i, j), smoke(x, y), result.densest, result.smoke);
    }
  result.velocity /= result.speed;
  result.pressure /= highest;
  result.smoke /= result.densest;
  return result;
}

constexpr int kSteps = 200;

class MirrorSizes : public testing::TestWithParam<Case> {};

TEST_P(MirrorSizes, IsItsOwnImage) {
  // Truth: u(x) = -u(-x), and v, phi and smoke the same on both sides; not a bit differs.
  const Case& c = GetParam();
  for (const bool upright : {true, false}) {
    const Asymmetry a = asymmetryAfter(kSteps, sceneOf(c, upright), upright);
    EXPECT_GT(a.speed, 0.5);
    EXPECT_GT(a.densest, 0.5);
    EXPECT_EQ(a.values, 0) << (upright ? "left and right" : "up and down") << ": velocity " << a.velocity
                           << " pressure " << a.pressure << " smoke " << a.smoke;
  }
}

constexpr const char* kDisk = "{circle: {radius: 0.12}}";
constexpr const char* kSmallDisk = "{circle: {radius: 0.06}}";
constexpr const char* kPlate = "{box: {size: [0.4, 0.004]}}";
constexpr const char* kUprightPlate = "{box: {size: [0.004, 0.4]}}";
constexpr const char* kBlade = "{box: {size: [0.3, 0.03]}}";
constexpr const char* kBlock = "{box: {size: [0.15, 0.2]}}";
constexpr const char* kSheet = "{box: {size: [0.3, 0.004]}}";

std::vector<Case> sizes() {
  std::vector<Case> cases;
  for (const auto& [n, m] :
       {std::pair{96, 144}, {100, 150}, {75, 100}, {101, 151}, {90, 160}, {144, 99}, {37, 53}})
    cases.push_back({"a disk on the axis", n, m, {{kDisk, 0, std::min(0.79, 0.6 * m / n)}}});
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Sizes, MirrorSizes, testing::ValuesIn(sizes()));

INSTANTIATE_TEST_SUITE_P(
    Solids, MirrorSizes,
    testing::Values(Case{"two disks", 101, 131, {{kSmallDisk, 0.2, 0.7}}},
                    Case{"a plate across", 75, 100, {{kPlate, 0, 0.703}}},
                    Case{"a plate across", 64, 100, {{kPlate, 0, 0.703}}},
                    Case{"a plate that halves its cells", 75, 100, {{kUprightPlate, 0, 0.803}}},
                    Case{"plates that halve their cells", 75, 100, {{kUprightPlate, 0.2, 0.703}}},
                    Case{"leaning plates", 96, 100, {{kPlate, 0.2, 0.7, 50}}},
                    Case{"leaning plates", 128, 128, {{kPlate, 0.2, 0.7, 50}}},
                    Case{"a plate along", 100, 128, {{kUprightPlate, 0, 0.803}}},
                    Case{"a roof", 100, 131, {{kBlade, 0.12, 0.7, -30}, {kSmallDisk, 0, 1}}}));

INSTANTIATE_TEST_SUITE_P(
    Moving, MirrorSizes,
    testing::Values(
        Case{"fans", 64, 80, {{kBlade, 0.2, 0.7, 10, 180}}},
        Case{"fans", 37, 53, {{kBlade, 0.2, 0.7, 10, 180}}},
        Case{"fans", 75, 100, {{kBlade, 0.2, 0.7, 10, 180}}},
        Case{"thin fans", 75, 100, {{kSheet, 0.2, 0.7, 10, 180}}},
        Case{"blocks that meet", 64, 80, {{kBlock, 0.15, 0.7, 0, 0, "0.075*sin(4*t)"}}},
        Case{"blocks that meet", 37, 53, {{kBlock, 0.15, 0.7, 0, 0, "0.075*sin(4*t)"}}},
        Case{"disks in a closed box",
             37,
             53,
             {{kSmallDisk, 0.2, 0.6, 0, 0, "0.1*sin(3*t)", "0.1*t"}},
             "slip",
             "slip"},
        Case{"plates that pass over the smoke", 75, 80, {{kUprightPlate, 0.2, 0.6, 0, 0, "0.19*sin(12*t)"}}},
        Case{"a press", 64, 80, {{kPlate, 0, 0.7, 0, 0, "0", "0.15*sin(3*t)"}}},
        Case{"a press", 100, 131, {{kPlate, 0, 0.7, 0, 0, "0", "0.15*sin(3*t)"}}},
        Case{"a disk up and down", 37, 53, {{kDisk, 0, 0.7, 0, 0, "0", "0.15*sin(3*t)"}}},
        Case{"steps of many cells", 64, 80, {{kBlock, 0.25, 0.7, 0, 0, "0.14*sin(20*t)"}}},
        Case{"free disks", 64, 80, {{kSmallDisk, 0.2, 0.7}}, "no-slip", "open", "1/100", true}));

INSTANTIATE_TEST_SUITE_P(
    Overlapping, MirrorSizes,
    testing::Values(
        Case{"fans that cut", 64, 80, {{kBlade, 0.1, 0.7, 10, 180}}},
        Case{"fans that cut", 37, 53, {{kBlade, 0.1, 0.7, 10, 180}}},
        Case{"fans that cut", 75, 100, {{kBlade, 0.12, 0.7, 10, 180}}},
        Case{"fans that cut", 128, 160, {{kBlade, 0.1, 0.7, 10, 180}}},
        Case{"fans whose tips cut", 64, 80, {{kBlade, 0.14, 0.7, 10, 180}}},
        Case{"fans across the walls", 64, 80, {{kBlade, 0.4, 0.7, 10, 180}}},
        Case{"thin fans that cut", 64, 80, {{kSheet, 0.1, 0.7, 10, 180}}},
        Case{"thin fans that cut", 75, 100, {{kSheet, 0.1, 0.7, 10, 180}}},
        Case{"turning blocks", 64, 80, {{kBlock, 0.07, 0.7, 0, 90}}},
        Case{"turning disks", 64, 80, {{kSmallDisk, 0.05, 0.7, 0, 90}}},
        Case{"blocks that slide into each other", 64, 80, {{kBlock, 0.1, 0.7, 0, 0, "0.075*sin(4*t)"}}},
        Case{"blocks that slide into each other", 75, 100, {{kBlock, 0.1, 0.7, 0, 0, "0.075*sin(4*t)"}}},
        Case{"disks that cut and part", 75, 80, {{kDisk, 0.1, 0.7, 0, 0, "0.12*sin(4*t)", "0.1*sin(3*t)"}}},
        Case{"blocks that meet across a periodic side",
             75,
             80,
             {{kBlock, 0.3, 0.7, 0, 0, "0.3*sin(4*t)"}},
             "periodic",
             "slip"},
        Case{"leaning blades that slide", 64, 80, {{kBlade, 0.1, 0.7, 25, 0, "0.1*sin(6*t)", "0.05*t"}}},
        Case{"plates along each other", 75, 80, {{kSheet, 0.12, 0.7, 0, 0, "0.1*sin(6*t)"}}},
        Case{"fans and a press",
             75,
             100,
             {{kBlade, 0.12, 0.7, 25, 180}, {kBlock, 0, 0.7, 0, 0, "0", "0.1*sin(5*t)"}}},
        Case{"fans around a disk", 101, 131, {{kBlade, 0.12, 0.7, 25, -120}, {kDisk, 0, 0.75}}},
        Case{"four thin blades", 90, 110, {{kSheet, 0.1, 0.7, 25, 180}, {kSheet, 0.15, 0.65, -40, -90}}},
        Case{"a box of plates that close it",
             75,
             80,
             {{kPlate, 0, 0.6}, {kPlate, 0, 0.8}, {kUprightPlate, 0.19, 0.7, 0, 0, "0.1*sin(5*t)"}}},
        Case{"turning blocks across periodic sides", 64, 80, {{kBlock, 0.45, 0.7, 0, 90}}, "periodic"},
        Case{"thin fans across periodic sides", 75, 80, {{kSheet, 0.4, 0.7, 10, 180}}, "periodic", "slip"},
        Case{"free disks",
             64,
             80,
             {{kSmallDisk, 0.05, 0.7}, {kDisk, 0.02, 0.6}},
             "no-slip",
             "open",
             "1/100",
             true}));

INSTANTIATE_TEST_SUITE_P(
    Walls, MirrorSizes,
    testing::Values(Case{"closed", 96, 100, {{kDisk, 0, 0.7}}, "slip", "slip"},
                    Case{"closed", 75, 75, {{kDisk, 0, 0.7}}, "slip", "slip"},
                    Case{"open", 100, 128, {{kDisk, 0, 0.7}}, "open", "open", "1/250"},
                    Case{"open", 101, 128, {{kDisk, 0, 0.7}}, "open", "open", "1/250"},
                    Case{"steps of many cells", 64, 80, {{kDisk, 0, 0.7}}, "open", "open", "1/8"},
                    Case{"periodic", 64, 96, {{kDisk, 0, 0.7}}, "periodic"},
                    Case{"periodic", 100, 90, {{kBlade, 0.25, 0.6, 10, 180}}, "periodic", "slip"},
                    Case{"periodic", 75, 128, {{kDisk, 0, 0.7}}, "periodic", "slip"}));

}  // namespace
}  // namespace smokebox

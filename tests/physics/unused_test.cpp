// Model no more than a scene needs: what a scene does not use has no memory, no stage in the plan, no time.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "world/plan.h"
#include "world/world.h"

namespace smokebox {
namespace {

constexpr int kCells = 96;

struct Feature {
  const char* stage;  // as the plan names it
  std::string fluid, solid, other;
  int fields;  // that it has at least, of its own
};

/// Wind past a disk. Without gravity and buoyancy: forces are a feature, too.
SceneDocument wind(const Feature& feature) {
  return SceneDocument::parse("domain: {size: [1, 1], resolution: " + std::to_string(kCells) +
                                  "}\nwalls: {left: {inflow: [1, 0]}, right: open}\ntime: {duration: 10, "
                                  "step: 1/96}\noutput: {fps: 1}\n"
                                  "fluid: {velocity: [\"1\", \"0.2*sin(pi*x)\"]" +
                                  feature.fluid +
                                  "}\nsolids: [{name: disk, shape: {circle: {radius: 0.1}}, position: "
                                  "[0.4, 0.52]" +
                                  feature.solid + "}]\n" + feature.other,
                              "wind.yaml");
}

const Feature kNone{"", "", "", "", 0};

// Each as it is named and used, and as it is named but switched off.
const std::pair<Feature, Feature> kFeatures[] = {
    {{"viscosity", ", viscosity: 1e-3", "", "", 4}, {"viscosity", ", viscosity: 0", "", "", 0}},
    {{"vorticity confinement", ", vorticity: 0.3", "", "", 3},
     {"vorticity confinement", ", vorticity: 0", "", "", 0}},
    {{"surface drag", "", ", drag: 0.5", "", 0}, {"surface drag", "", ", drag: 0", "", 0}},
    {{"smoke", "", "", "smoke: {sources: [{shape: {circle: {center: [0.1, 0.5], radius: 0.05}}, rate: 1}]}\n",
      5},
     {"smoke", "", "", "smoke: {buoyancy: 0.6, sources: []}\n", 0}},
    {{"temperature", "", "", "temperature: {start: 20}\n", 2}, kNone},
    {{"diffusion of heat", "", "", "temperature: {start: 20, diffusivity: 1e-3}\n", 4}, kNone},
};

bool modelled(const SceneDocument& scene, const std::string& stage) {
  const Plan plan = planOf(scene.spec());
  const auto line = std::find_if(plan.lines.begin(), plan.lines.end(),
                                 [&](const PlanLine& candidate) { return candidate.stage == stage; });
  EXPECT_NE(line, plan.lines.end()) << stage;
  return line != plan.lines.end() && line->modelled;
}

TEST(Unused, AFluidAloneHasJustItsOwnFields) {
  // Truth: the memory of a fluid without any part and of the boundary's five fields; none without a fluid.
  const World world(wind(kNone), {});
  ThreadPool pool(1);
  const Fluid fluid(world.boundary(), {}, pool);
  EXPECT_EQ(world.bytes(), fluid.bytes() + 5 * world.boundary().openX.bytes());
  EXPECT_EQ(world.smoke(), nullptr);
  EXPECT_EQ(world.heat(), nullptr);
  const World still(SceneDocument::parse("domain: {size: [1, 1], resolution: 96}\n"
                                         "solids: [{name: disk, shape: {circle: {radius: 0.1}}}]\n",
                                         "still.yaml"),
                    {});
  EXPECT_EQ(still.fluid(), nullptr);
  EXPECT_EQ(still.bytes(), 0u);
}

TEST(Unused, AFeatureHasMemoryOnlyWhereItIsUsed) {
  // Truth: what is switched off is not planned, has no byte, and leaves the flow as it is to the last bit;
  // what is used is planned, and has its fields.
  World plain(wind(kNone), {});
  for (int k = 0; k < 5; ++k) plain.step();
  const std::size_t field = Field(kCells, kCells).bytes();
  for (const auto& [on, off] : kFeatures) {
    World world(wind(off), {});
    for (int k = 0; k < 5; ++k) world.step();
    EXPECT_EQ(world.bytes(), plain.bytes()) << on.stage;
    EXPECT_EQ(world.stateHash(), plain.stateHash()) << on.stage;
    EXPECT_FALSE(modelled(wind(off), on.stage));
    EXPECT_TRUE(modelled(wind(on), on.stage));
    // The lists of faces near surfaces may be shorter with a feature: what has no field is not compared.
    if (on.fields > 0) {
      EXPECT_GE(World(wind(on), {}).bytes(), World(wind(kNone), {}).bytes() + on.fields * field) << on.stage;
    }
  }
}

/// The median over the steps of the share of a step that stages take that are not among `used`.
double idleShare(const SceneDocument& scene, const std::set<std::string>& used) {
  World world(scene, {});
  std::vector<double> shares;
  for (int k = 0; k < 41; ++k) {
    world.step();
    double idle = 0;
    for (const auto& [name, ms] : world.figures().stageMs) idle += used.contains(name) ? 0 : ms;
    shares.push_back(idle / world.figures().totalMs);
  }
  std::nth_element(shares.begin(), shares.begin() + 20, shares.end());
  return shares[20];
}

TEST(Unused, StagesThatHaveNothingToDoTakeNoTime) {
  // Truth: under 1% of a step together, in half of the steps at least, and more for what is used: forces,
  // friction, smoke, heat, and the cover of the grid by a solid that moves.
  const std::set<std::string> fluid = {"advect", "project"};
  EXPECT_LT(idleShare(wind(kNone), fluid), 0.01);
  EXPECT_LT(idleShare(wind({"", "", ", motion: {velocity: [0, 0]}", "", 0}), fluid), 0.01);
  EXPECT_GT(idleShare(wind({"", "", ", motion: {velocity: [0.1, 0]}", "", 0}), fluid), 0.01);
  for (const auto& [on, off] : kFeatures) {
    EXPECT_LT(idleShare(wind(off), fluid), 0.01) << on.stage;
    if (on.fields > 0) {
      EXPECT_GT(idleShare(wind(on), fluid), 0.01) << on.stage;
    }
  }
}

}  // namespace
}  // namespace smokebox

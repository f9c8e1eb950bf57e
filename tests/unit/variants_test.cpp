#include "app/variants.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/errors.h"

namespace smokebox {
namespace {

std::string messageOf(const std::vector<std::string>& varied) {
  try {
    variantsOf(varied);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Variants, AreAllCombinationsTheFirstKeySlowest) {
  // Truth: two keys of two values are four runs.
  const auto variants = variantsOf({"fluid.vorticity=0.35,0", "smoke.buoyancy = 1, 2"});
  ASSERT_EQ(variants.size(), 4u);
  EXPECT_EQ(variants[0].label, "fluid.vorticity = 0.35, smoke.buoyancy = 1");
  EXPECT_EQ(variants[1].label, "fluid.vorticity = 0.35, smoke.buoyancy = 2");
  EXPECT_EQ(variants[3].label, "fluid.vorticity = 0, smoke.buoyancy = 2");
  EXPECT_EQ(variants[2].settings[0], (std::pair<std::string, std::string>("fluid.vorticity", "0")));
}

TEST(Variants, CommasInsideOfAValueDoNotPartIt) {
  // Truth: lists, maps, quoted text and function calls are one value each.
  const auto variants = variantsOf({R"(gravity=[0, -9.81],[0, 0],{a: 1, b: 2},"x,y",max(1,2))"});
  ASSERT_EQ(variants.size(), 5u);
  EXPECT_EQ(variants[0].settings[0].second, "[0, -9.81]");
  EXPECT_EQ(variants[2].settings[0].second, "{a: 1, b: 2}");
  EXPECT_EQ(variants[3].settings[0].second, "\"x,y\"");
  EXPECT_EQ(variants[4].settings[0].second, "max(1,2)");
}

TEST(Variants, WhatCannotBeComparedIsRefusedWithAReason) {
  // Truth: each of these is wrong usage, and the message says why.
  EXPECT_NE(messageOf({"fluid.vorticity=1"}).find("nothing to compare"), std::string::npos);
  EXPECT_NE(messageOf({}).find("nothing to compare"), std::string::npos);
  EXPECT_NE(messageOf({"fluid.vorticity"}).find("KEY=VALUE"), std::string::npos);
  EXPECT_NE(messageOf({"=1,2"}).find("KEY=VALUE"), std::string::npos);
  EXPECT_NE(messageOf({"a=1,,2"}).find("empty"), std::string::npos);
  EXPECT_NE(messageOf({"a=1,1"}).find("twice"), std::string::npos);
  EXPECT_NE(messageOf({"a=1,2", "a=3,4"}).find("twice"), std::string::npos);
  EXPECT_NE(messageOf({"a=1,2,3,4", "b=1,2,3"}).find("more than 9"), std::string::npos);
  EXPECT_EQ(messageOf({"a=1,2,3", "b=1,2,3"}), "no error");
}

TEST(Variants, LabelsGetShorterBeforeTheyLoseAValue) {
  // Truth: where labels do not fit they lose the beginnings of the keys, then the keys; never a value, nor
  // what tells two keys apart.
  const auto labels = [](const std::vector<std::string>& varied, std::size_t room) {
    return panelLabels(variantsOf(varied),
                       [&](const std::vector<std::string>& all) {
                         return std::all_of(all.begin(), all.end(),
                                            [&](const auto& one) { return one.size() <= room; });
                       })
        .back();
  };
  const std::vector<std::string> varied{"fluid.vorticity=0,1", "smoke.buoyancy=2,33"};
  EXPECT_EQ(labels(varied, 80), "fluid.vorticity = 1, smoke.buoyancy = 33");
  EXPECT_EQ(labels(varied, 30), "vorticity = 1, buoyancy = 33");
  EXPECT_EQ(labels(varied, 20), "1, 33");
  EXPECT_EQ(labels(varied, 0), "1, 33");
  EXPECT_EQ(labels({"title=a,b"}, 4), "b");
  EXPECT_EQ(labels({"solids.a.angle=1,2", "solids.b.angle=3,4"}, 25), "2, 4");
}

constexpr const char* kScene = R"(
domain: {size: [2, 1], resolution: 32}
time: {step: 1/60, duration: 1}
fluid: {}
output: {size: [64, 32], fps: 30}
)";

TEST(Variants, RunsThatDoNotGoInStepAreRefused) {
  // Truth: a smaller step is fine, as frames come at the same times; another frame rate, duration or size is
  // not.
  const SceneDocument scene = SceneDocument::parse(kScene, "scene.yaml");
  EXPECT_EQ(variantScenes(scene, variantsOf({"time.step=1/60,1/120"})).size(), 2u);
  EXPECT_THROW(variantScenes(scene, variantsOf({"time.duration=1,2"})), UsageError);
  EXPECT_THROW(variantScenes(scene, variantsOf({"output.fps=30,60"})), UsageError);
  EXPECT_THROW(variantScenes(scene, variantsOf({"output.size=[64, 32],[128, 64]"})), UsageError);
}

TEST(Variants, AValueThatTheSceneDoesNotTakeIsNamedWithItsOption) {
  // Truth: the message names --vary, the key and what is wrong with it.
  const SceneDocument scene = SceneDocument::parse(kScene, "scene.yaml");
  try {
    variantScenes(scene, variantsOf({"fluid.viscosity=0,-1"}));
    FAIL() << "no error";
  } catch (const SceneError& error) {
    EXPECT_NE(std::string(error.what()).find("--vary fluid.viscosity=-1"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace smokebox

#include "scene/document.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/maths.h"

namespace smokebox {
namespace {

constexpr const char* kExample = R"yaml(title: Smoke around a car
domain: {size: [4, 2], resolution: 512}        # metres; cells along x, cells are square
walls:  {left: {inflow: [1, 0]}, right: open, bottom: no-slip, top: slip}
time:   {step: 1/120, duration: 12}
gravity: [0, -9.81]
fluid:  {density: 1.2, viscosity: 0, vorticity: 0.3, velocity: ["0.1*sin(pi*y)", "0"]}
smoke:
  buoyancy: 0.5
  sources:
    - {shape: {circle: {center: [0.3, 0.5], radius: 0.05}}, rate: 4, velocity: [1, 0], color: "#ffb347", from: 0, until: 9}
solids:
  - name: car
    shape: {polygon: [[1.0, 0.1], [2.4, 0.1], [2.4, 0.4], [2.0, 0.7], [1.4, 0.7], [1.0, 0.4]]}
    drag: 1
  - name: fan
    shape: {box: {size: [0.6, 0.05]}}
    position: [3, 1]
    angle: 20
    motion: {velocity: [0, 0], spin: 180}
  - name: gate
    shape: {capsule: {length: 0.4, radius: 0.03}}
    motion: {keyframes: [{at: 0, position: [2.8, 0.3]}, {at: 2, position: [2.8, 0.9], angle: 90}], smooth: true}
  - name: piston
    shape: {box: {size: [0.2, 0.2]}}
    motion: {expression: {x: "3.6", y: "0.5 + 0.2*sin(2*pi*t)", angle: "0"}}
events:
  - {at: 2,  set: {fluid.vorticity: 0}}
  - {at: 3,  force: {circle: {center: [1, 1], radius: 0.2}, acceleration: [5, 0], for: 0.2}}
  - {every: 1, from: 1, until: 5, burst: {circle: {center: [0.5, 0.5], radius: 0.1}, smoke: 1, color: "#88ccff"}}
probes:    [{name: p, at: [2, 1]}, {name: cabin, region: {circle: {center: [2, 1], radius: 0.3}}, follow: gate}]
view:
  layers: [smoke, solids, bodies, {pressure: {opacity: 0.6}}, collisions, springs, caption]
  captions: [{from: 0, until: 3, text: "vorticity on"}]
output: {size: [1280, 720], fps: 30}
method: {}
)yaml";

TEST(SceneDocument, TheExampleOfTheDesignReadsWithoutAProblem) {
  // Truth: the values that stand in the text.
  const SceneDocument document = SceneDocument::parse(kExample, "scenes/example.yaml");
  for (const Problem& problem : document.problems()) ADD_FAILURE() << problem.text();
  const SceneSpec spec = document.spec();
  EXPECT_EQ(spec.name, "example");
  EXPECT_EQ(spec.title, "Smoke around a car");
  EXPECT_EQ(spec.domain.grid.nx, 512);
  EXPECT_EQ(spec.domain.grid.ny, 256);
  EXPECT_EQ(spec.domain.grid.h, 4.0 / 512);
  EXPECT_EQ(spec.domain.wall(Side::left).kind, WallKind::inflow);
  EXPECT_EQ(spec.domain.wall(Side::left).velocity[0](0, 0, 0), 1);
  EXPECT_EQ(spec.domain.wall(Side::right).kind, WallKind::open);
  EXPECT_EQ(spec.domain.wall(Side::bottom).kind, WallKind::noSlip);
  EXPECT_EQ(spec.domain.wall(Side::top).kind, WallKind::slip);
  EXPECT_EQ(spec.time.step, 1.0 / 120);
  EXPECT_EQ(spec.time.steps, 1440);
  EXPECT_EQ(spec.time.stepsPerFrame, 4);
  EXPECT_EQ(spec.gravity, (Vec2{0, -9.81}));
  EXPECT_TRUE(spec.hasFluid);
  EXPECT_EQ(spec.fluid.density, 1.2);
  EXPECT_EQ(spec.fluid.vorticity, 0.3);
  EXPECT_DOUBLE_EQ(spec.fluid.velocity[0](9, 0.5, 0), 0.1);
  EXPECT_EQ(spec.fluid.velocity[1](9, 0.5, 0), 0);

  EXPECT_EQ(spec.smoke.buoyancy, 0.5);
  ASSERT_EQ(spec.smoke.sources.size(), 1u);
  const SourceSpec& source = spec.smoke.sources[0];
  EXPECT_EQ(std::get<CircleShape>(source.shape.shape).radius, 0.05);
  EXPECT_EQ(source.shape.pose.position, (Vec2{0.3, 0.5}));
  EXPECT_EQ(source.rate, 4);
  EXPECT_EQ(source.velocity, (Vec2{1, 0}));
  EXPECT_EQ(source.color, (Color{1, 0xb3 / 255.f, 0x47 / 255.f}));
  EXPECT_EQ(source.until, 9);

  ASSERT_EQ(spec.solids.size(), 4u);
  EXPECT_EQ(spec.solids[0].name, "car");
  EXPECT_EQ(std::get<PolygonShape>(spec.solids[0].shape.shape).points.size(), 6u);
  EXPECT_EQ(spec.solids[0].drag, 1);
  EXPECT_TRUE(spec.solids[0].motion.isStill());
  EXPECT_EQ(spec.solids[1].drag, 0);
  EXPECT_EQ(spec.solids[1].shape.pose.position, (Vec2{3, 1}));
  EXPECT_DOUBLE_EQ(spec.solids[1].motion.poseAt(0.5, spec.solids[1].shape.pose).angleRad, radians(110));
  const Pose gate = spec.solids[2].motion.poseAt(1, spec.solids[2].shape.pose);
  EXPECT_DOUBLE_EQ(gate.position.y, 0.6);
  EXPECT_DOUBLE_EQ(gate.angleRad, radians(45));
  const Pose piston = spec.solids[3].motion.poseAt(0.25, spec.solids[3].shape.pose);
  EXPECT_DOUBLE_EQ(piston.position.x, 3.6);
  EXPECT_DOUBLE_EQ(piston.position.y, 0.7);

  ASSERT_EQ(spec.events.size(), 3u);
  EXPECT_EQ(spec.events[0].first, 2);
  EXPECT_EQ(std::get<SetAction>(spec.events[0].action).path, "fluid.vorticity");
  EXPECT_EQ(std::get<SetAction>(spec.events[0].action).value, "0");
  EXPECT_EQ(std::get<ForceAction>(spec.events[1].action).duration, 0.2);
  EXPECT_EQ(spec.events[2].every, 1);
  EXPECT_EQ(spec.events[2].until, 5);
  EXPECT_EQ(spec.smokeColors().size(), 2u);
  ASSERT_EQ(spec.probes.size(), 2u);
  EXPECT_EQ(spec.probes[0].at, (Vec2{2, 1}));
  EXPECT_EQ(spec.probes[1].follow, "gate");
  ASSERT_EQ(spec.view.layers.size(), 4u);
  EXPECT_EQ(spec.view.layers[2].kind, LayerKind::pressure);
  EXPECT_EQ(spec.view.layers[2].opacity, 0.6);
  EXPECT_EQ(spec.view.captions.at(0).text, "vorticity on");
  EXPECT_EQ(spec.output.width, 1280);
  EXPECT_EQ(spec.output.fps, 30);
  EXPECT_EQ(spec.method.tolerance, 1e-5);
}

}  // namespace
}  // namespace smokebox

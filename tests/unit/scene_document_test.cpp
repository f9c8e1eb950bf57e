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
bodies:
  - {name: ball, shape: {circle: {radius: 0.1}}, position: [2, 1.6], angle: 0, velocity: [0, 0], spin: 0,
     density: 3, bounce: 0.5, friction: 0.3, drag: 0.2, ignore: [a], held_until: 1}
  - {name: arm, shape: {box: {size: [0.4, 0.05]}}, position: [2.15, 1.5], ignore: a}
springs:   [{name: s, from: {body: ball, at: [0, 0.1]}, to: {point: [2, 2]}, length: 0.3, stiffness: 40, damping: 0.5}]
joints:    [{pin: [ball, arm], at: [2, 1.5]}]
particles: [{position: [1, 1.5], mass: 0.01, radius: 0.01, velocity: [0, 0]}]
cloth:     [{name: sheet, corner: [0.5, 1.2], size: [1, 0.6], cells: [24, 14], mass: 0.05, stiffness: 200, pinned: top}]
events:
  - {at: 2,  set: {fluid.vorticity: 0}}
  - {at: 3,  force: {circle: {center: [1, 1], radius: 0.2}, acceleration: [5, 0], for: 0.2}}
  - {every: 1, from: 1, until: 5, burst: {circle: {center: [0.5, 0.5], radius: 0.1}, smoke: 1, color: "#88ccff"}}
  - {at: 3,  impulse: {body: ball, value: [0, 2]}}
  - {at: 4,  pull: {body: ball, at: [0, 0], to: [3, 1.5], stiffness: 20, for: 1}}
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

  ASSERT_EQ(spec.events.size(), 5u);
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
  ASSERT_EQ(spec.view.layers.size(), 7u);
  EXPECT_EQ(spec.view.layers[2].kind, LayerKind::bodies);
  EXPECT_EQ(spec.view.layers[3].kind, LayerKind::pressure);
  EXPECT_EQ(spec.view.layers[3].opacity, 0.6);
  EXPECT_EQ(spec.view.captions.at(0).text, "vorticity on");
  EXPECT_EQ(spec.output.width, 1280);
  EXPECT_EQ(spec.output.fps, 30);
  EXPECT_EQ(spec.method.tolerance, 1e-5);
}

const std::string kDomain = "domain: {size: [2, 1], resolution: 64}\n";
SceneSpec specOf(const std::string& rest) { return SceneDocument::parse(kDomain + rest, "s.yaml").spec(); }

TEST(SceneDocument, DefaultsAreThoseOfTheDesign) {
  // Truth: a scene with nothing but a domain.
  const SceneSpec spec = specOf("");
  EXPECT_EQ(spec.domain.grid, (Grid{64, 32, 1.0 / 32}));
  for (const WallSpec& wall : spec.domain.walls) EXPECT_EQ(wall.kind, WallKind::slip);
  EXPECT_EQ(spec.time.step, 1.0 / 120);
  EXPECT_EQ(spec.time.steps, 1200);
  EXPECT_EQ(spec.gravity, (Vec2{0, 0}));
  EXPECT_FALSE(spec.hasFluid);
  EXPECT_EQ(spec.output.width, 1280);
  EXPECT_EQ(spec.output.height, 720);
  EXPECT_EQ(spec.output.fps, 30);
  EXPECT_EQ(spec.method.maxIterations, 200);
  ASSERT_EQ(spec.view.layers.size(), 3u);
  EXPECT_EQ(spec.view.layers[0].kind, LayerKind::smoke);
  EXPECT_EQ(spec.view.layers[1].kind, LayerKind::solids);
  EXPECT_EQ(spec.view.layers[2].kind, LayerKind::caption);
}

TEST(SceneDocument, AFluidIsBuiltOnlyWhereItIsNamed) {
  // Truth: fluid, smoke or an inflow, even empty ones; nothing else.
  EXPECT_TRUE(specOf("fluid: {}").hasFluid);
  EXPECT_TRUE(specOf("fluid:").hasFluid);
  EXPECT_TRUE(specOf("smoke: {}").hasFluid);
  EXPECT_TRUE(specOf("walls: {left: {inflow: [1, 0]}, right: open}").hasFluid);
  EXPECT_FALSE(specOf("walls: {left: open}\ngravity: [0, -1]").hasFluid);
}

TEST(SceneDocument, NumbersMayBeArithmeticAnywhere) {
  // Truth: worked out by hand; a leading zero is no octal.
  EXPECT_EQ(specOf("gravity: [0, -9.81/2]").gravity.y, -4.905);
  EXPECT_EQ(specOf("gravity: [010, 2^3]").gravity, (Vec2{10, 8}));
  EXPECT_EQ(specOf("gravity: [\"2*3\", +1e0]").gravity, (Vec2{6, 1}));
  EXPECT_EQ(specOf("output: {fps: 6*10}").output.fps, 60);
}

TEST(SceneDocument, TheDefaultStepFitsTheFrames) {
  // Truth: near 1/120 s, and a whole number of steps a frame for any rate.
  for (int fps : {1, 24, 25, 30, 50, 60, 100, 144, 240}) {
    const SceneSpec spec = specOf("output: {fps: " + std::to_string(fps) + "}");
    EXPECT_DOUBLE_EQ(spec.time.step * spec.time.stepsPerFrame * fps, 1) << fps;
    EXPECT_LE(spec.time.step, 1.0 / 70) << fps;
  }
  // A rounded decimal is as good as the fraction that it stands for.
  EXPECT_EQ(specOf("time: {step: 0.00833333, duration: 12}").time.steps, 1440);
}

TEST(SceneDocument, DragFollowsTheViscosity) {
  // Truth: default 1 with viscosity, 0 without; what is written counts.
  const std::string solid = "solids: [{shape: {circle: {radius: 0.1}}, position: [1, 0.5]}]\n";
  EXPECT_EQ(specOf(solid + "fluid: {viscosity: 1e-3}").solids[0].drag, 1);
  EXPECT_EQ(specOf(solid + "fluid: {}").solids[0].drag, 0);
  EXPECT_EQ(specOf(solid).solids[0].name, "solid 1");
}

TEST(SceneDocument, ShapesAreReadWithTheirPlaces) {
  // Truth: every kind of shape, with position, angle and centre beside or inside.
  auto region = [](const std::string& shape) {
    return *specOf("probes: [{region: " + shape + "}]").probes.at(0).region;
  };
  EXPECT_EQ(std::get<BoxShape>(region("{box: {size: [1, 2]}, position: [1, 0.5], angle: 90}").shape).size,
            (Vec2{1, 2}));
  EXPECT_EQ(region("{box: {size: [1, 2]}, position: [1, 0.5], angle: 90}").pose,
            (Pose{{1, 0.5}, radians(90)}));
  EXPECT_EQ(std::get<EllipseShape>(region("{ellipse: {radii: [0.2, 0.1], center: [1, 0.5]}}").shape).radii,
            (Vec2{0.2, 0.1}));
  EXPECT_EQ(region("{circle: {radius: 0.1, center: [0.5, 0.25]}, position: [0.5, 0.25]}").pose.position,
            (Vec2{1, 0.5}));
  const auto capsule = std::get<CapsuleShape>(region("{capsule: {length: 0.4, radius: 0.03}}").shape);
  EXPECT_EQ(capsule.length, 0.4);
  EXPECT_EQ(capsule.radius, 0.03);
  EXPECT_EQ(std::get<RegularShape>(region("{regular: {sides: 5, radius: 0.3}}").shape).sides, 5);
  const auto joined = std::get<UnionShape>(
      region("{union: [{box: {size: [1, 1]}}, {circle: {radius: 1}, position: [1, 0]}]}").shape);
  ASSERT_EQ(joined.parts.size(), 2u);
  EXPECT_EQ(joined.parts[1].pose.position, (Vec2{1, 0}));
}

TEST(SceneDocument, ACentreInASolidIsItsPlaceUnlessItHasOne) {
  // Truth: without a position the centre is where it rests and turns; with one the centre is an offset from
  // it.
  const SolidSpec plain = specOf("solids: [{shape: {circle: {center: [1, 0.5], radius: 0.1}}}]").solids[0];
  EXPECT_EQ(plain.shape.pose.position, (Vec2{1, 0.5}));
  EXPECT_TRUE(std::holds_alternative<CircleShape>(plain.shape.shape));
  const SolidSpec offset =
      specOf("solids: [{shape: {circle: {center: [0.2, 0], radius: 0.1}}, position: [1, 0.5]}]").solids[0];
  EXPECT_EQ(offset.shape.pose.position, (Vec2{1, 0.5}));
  EXPECT_EQ(std::get<UnionShape>(offset.shape.shape).parts.at(0).pose.position, (Vec2{0.2, 0}));
}

TEST(SceneDocument, KeyframesHoldWhatTheyLeaveOut) {
  // Truth: position and angle of the key before, at first those of rest.
  const SolidSpec solid =
      specOf(
          "solids: [{shape: {circle: {radius: 0.1}}, position: [1, 0.5], angle: 30, motion: {keyframes: "
          "[{at: 0, angle: 60}, {at: 1, position: [1.5, 0.5]}, {at: 2, angle: 90}], repeat: true}}]")
          .solids[0];
  const Pose rest = solid.shape.pose;
  EXPECT_EQ(solid.motion.poseAt(0, rest), (Pose{{1, 0.5}, radians(60)}));
  EXPECT_EQ(solid.motion.poseAt(1, rest), (Pose{{1.5, 0.5}, radians(60)}));
  EXPECT_EQ(solid.motion.poseAt(1.999999999, rest).position, (Vec2{1.5, 0.5}));
  EXPECT_EQ(solid.motion.poseAt(3, rest), solid.motion.poseAt(1, rest));
}

TEST(SceneDocument, AliasesShareWhatTheyName) {
  // Truth: an alias means the value at its anchor.
  const SceneSpec spec = specOf(
      "solids:\n- {name: a, shape: &s {circle: {radius: 0.1}}, position: [0.5, 0.5]}\n"
      "- {name: b, shape: *s, position: [1.5, 0.5]}\n");
  EXPECT_EQ(std::get<CircleShape>(spec.solids[1].shape.shape).radius, 0.1);
}

TEST(SceneDocument, LayersTakeTheirOptions) {
  // Truth: each option in its field.
  const SceneSpec spec = specOf(
      "view: {background: light, camera: {center: [1, 0.5], height: 0.5}, layers: [time, joints, trails, "
      "{vorticity: {opacity: 0.5, range: [-2, 2], bar: false}}, {velocity: {spacing: 0.1, scale: 0.2, color: "
      "red}}]}");
  ASSERT_EQ(spec.view.layers.size(), 5u);
  EXPECT_EQ(spec.view.layers[0].kind, LayerKind::time);
  EXPECT_EQ(spec.view.layers[3].range, (std::array<double, 2>{-2, 2}));
  EXPECT_FALSE(spec.view.layers[3].bar);
  EXPECT_EQ(spec.view.layers[4].spacing, 0.1);
  EXPECT_EQ(spec.view.layers[4].color, (Color{1, 0, 0}));
  EXPECT_GT(spec.view.background.r, 0.9f);
  EXPECT_EQ(spec.view.camera.height, 0.5);
}

TEST(SceneDocument, EventsBecomeSingleActions) {
  // Truth: one entry for every solid named and every path set.
  const SceneSpec spec = specOf(
      "solids: [{name: a, shape: {circle: {radius: .1}}, position: [1, .5]}, {name: b, shape: {circle: "
      "{radius: .1}}, "
      "position: [.5, .5]}]\nfluid: {}\nevents:\n- {at: 1, hide: [a, b]}\n- {at: 2, show: a}\n- {at: 3, "
      "stop: b}\n"
      "- {at: 4, set: {fluid.vorticity: 1, gravity: [0, 1]}}\n- {every: 2, caption: {text: x, for: 1}}\n"
      "- {at: 5, force: {box: {size: [1, 1]}, position: [1, .5], acceleration: [5, 0]}}\n");
  ASSERT_EQ(spec.events.size(), 8u);
  EXPECT_EQ(std::get<VisibilityAction>(spec.events[1].action).name, "b");
  EXPECT_FALSE(std::get<VisibilityAction>(spec.events[1].action).visible);
  EXPECT_TRUE(std::get<VisibilityAction>(spec.events[2].action).visible);
  EXPECT_EQ(std::get<StopAction>(spec.events[3].action).solid, "b");
  EXPECT_EQ(std::get<SetAction>(spec.events[5].action).value, "[0, 1]");
  EXPECT_EQ(spec.events[6].every, 2);
  EXPECT_EQ(spec.events[6].first, 0);
  EXPECT_EQ(std::get<CaptionAction>(spec.events[6].action).duration, 1);
  EXPECT_EQ(std::get<ForceAction>(spec.events[7].action).duration, 0);
  EXPECT_EQ(std::get<ForceAction>(spec.events[7].action).shape.pose.position, (Vec2{1, 0.5}));
}

TEST(SceneDocument, EventsShowAndHideLayers) {
  // Truth: showing a layer is setting its `shown`; a name that is a solid's too means the solid.
  const SceneSpec spec = specOf(
      "fluid: {}\nsolids: [{name: speed, shape: {circle: {radius: .1}}, position: [1, .5]}]\n"
      "view: {layers: [smoke, bodies, speed, {pressure: {shown: false}}]}\n"
      "events:\n- {at: 1, show: [pressure, bodies]}\n- {at: 2, hide: smoke}\n- {at: 3, hide: speed}\n");
  ASSERT_EQ(spec.view.layers.size(), 4u);
  EXPECT_TRUE(spec.view.layers[0].shown);
  EXPECT_FALSE(spec.view.layers[3].shown);
  ASSERT_EQ(spec.events.size(), 4u);
  EXPECT_EQ(std::get<SetAction>(spec.events[0].action).path, "view.layers.pressure.shown");
  EXPECT_EQ(std::get<SetAction>(spec.events[0].action).value, "true");
  EXPECT_EQ(std::get<SetAction>(spec.events[1].action).path, "view.layers.bodies.shown");
  EXPECT_EQ(std::get<SetAction>(spec.events[2].action).value, "false");
  EXPECT_EQ(std::get<VisibilityAction>(spec.events[3].action).name, "speed");
}

TEST(SceneDocument, ColoursAreReadAsWritten) {
  // Truth: hexadecimal digits and a name of CSS.
  EXPECT_EQ(parseColor("#fff"), (Color{1, 1, 1}));
  EXPECT_EQ(parseColor("#88ccff"), (Color{0x88 / 255.f, 0xcc / 255.f, 1}));
  EXPECT_EQ(parseColor("orange"), (Color{1, 165 / 255.f, 0}));
  for (const char* wrong : {"", "#", "#ff", "#ffff", "#gggggg", "orangee", "#12345678"})
    EXPECT_FALSE(parseColor(wrong).has_value()) << wrong;
}

}  // namespace
}  // namespace smokebox

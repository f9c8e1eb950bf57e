// Bodies, springs, joints, particles, cloth and the events that act on them: what is read, and what is
// refused with its place.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>

#include "base/maths.h"
#include "scene/document.h"
#include "scene/places.h"
#include "scene/tree_path.h"

namespace smokebox {
namespace {

const std::string kDomain = "domain: {size: [4, 2], resolution: 64}\n";
const std::string kBall = "bodies: [{name: ball, shape: {circle: {radius: 0.1}}, position: [1, 1]}]\n";
const std::string kTwo =
    "bodies:\n- {name: ball, shape: {circle: {radius: 0.1}}, position: [1, 1]}\n"
    "- {name: arm, shape: {box: {size: [0.4, 0.1]}}, position: [2, 1]}\n";

SceneSpec specOf(const std::string& rest) { return SceneDocument::parse(kDomain + rest, "s.yaml").spec(); }

std::string problemsOf(const std::string& rest) {
  std::string all;
  for (const Problem& problem : SceneDocument::parse(kDomain + rest, "s.yaml").problems())
    all += problem.text() + "\n";
  return all;
}

/// The text is wrong in just one way, and the message has all these parts.
void expectFault(const std::string& text, const std::vector<std::string>& parts) {
  const std::string problems = problemsOf(text);
  EXPECT_EQ(std::count(problems.begin(), problems.end(), '\n'), 1) << problems;
  for (const std::string& part : parts)
    EXPECT_NE(problems.find(part), std::string::npos) << "lacks: " << part << "\ngot: " << problems;
}

Vec2 centreOf(const SceneSpec& spec, int body) {
  return placeAtStart(spec, {HoldSpec::Of::body, body, -1, {}});
}

TEST(SceneBodies, DefaultsAreThoseOfTheDesign) {
  // Truth: density 1, no bounce, friction 0.5, drag as solids have it.
  const BodySpec body = specOf("bodies: [{shape: {circle: {radius: 0.1}}, position: [1, 1]}]\n").bodies.at(0);
  EXPECT_EQ(body.name, "body 1");
  EXPECT_EQ(body.density, 1);
  EXPECT_FALSE(body.mass.has_value());
  EXPECT_EQ(body.bounce, 0);
  EXPECT_EQ(body.friction, 0.5);
  EXPECT_EQ(body.drag, 0);
  EXPECT_EQ(body.gravityScale, 1);
  EXPECT_EQ(body.heldUntil, 0);
  EXPECT_EQ(specOf("fluid: {viscosity: 1}\n" + kBall).bodies.at(0).drag, 1);
}

TEST(SceneBodies, EveryKeyIsTaken) {
  // Truth: what stands in the text; angles and spins in degrees.
  const SceneSpec spec = specOf(
      "bodies:\n- {name: b, shape: {box: {size: [0.4, 0.2]}}, position: [1, 1], angle: 90, velocity: [1, "
      "2],\n"
      "   spin: 180, mass: 3, bounce: 0.5, friction: 0.25, drag: 0.125, linear_damping: 0.1,\n"
      "   angular_damping: 0.2, gravity_scale: -1, ignore: [a, c], held_until: 2, color: red}\n"
      "- {name: d, shape: {circle: {radius: 0.1}}, position: [3, 1], density: 3, ignore: a, held: true}\n"
      "- {name: e, shape: {circle: {radius: 0.1}}, position: [2, 1], ignore: c}\n");
  const BodySpec& b = spec.bodies.at(0);
  EXPECT_DOUBLE_EQ(b.pose.angleRad, kPi / 2);
  EXPECT_EQ(b.velocity, (Vec2{1, 2}));
  EXPECT_DOUBLE_EQ(b.spinRad, kPi);
  EXPECT_EQ(b.mass, 3);
  EXPECT_EQ(b.bounce, 0.5);
  EXPECT_EQ(b.friction, 0.25);
  EXPECT_EQ(b.drag, 0.125);
  EXPECT_EQ(b.linearDamping, 0.1);
  EXPECT_EQ(b.angularDamping, 0.2);
  EXPECT_EQ(b.gravityScale, -1);
  EXPECT_EQ(b.ignore, (std::vector<std::string>{"a", "c"}));
  EXPECT_EQ(b.heldUntil, 2);
  EXPECT_TRUE(b.color.has_value());
  EXPECT_EQ(spec.bodies.at(1).heldUntil, kForever);
  EXPECT_EQ(spec.bodies.at(1).density, 3);
}

TEST(SceneBodies, AnOutlineTurnsAboutItsCentreOfMass) {
  // Truth: the triangle's (0, 0) goes to the position, so its centre of mass is a third of its legs away from
  // there, whatever the angle.
  const std::string triangle = "shape: {polygon: [[0, 0], [0.3, 0], [0, 0.6]]}";
  for (const char* angle : {"0", "90", "-37"}) {
    const SceneSpec spec =
        specOf("bodies: [{" + triangle + ", position: [1, 1], angle: " + std::string(angle) + "}]\n");
    EXPECT_NEAR(centreOf(spec, 0).x, 1.1, 1e-12);
    EXPECT_NEAR(centreOf(spec, 0).y, 1.2, 1e-12);
  }
  // Without a place its points are those of the world, and it turns on the spot.
  const SceneSpec world = specOf("bodies: [{shape: {polygon: [[1, 1], [1.3, 1], [1, 1.6]]}, angle: 180}]\n");
  EXPECT_NEAR(centreOf(world, 0).x, 1.1, 1e-12);
  EXPECT_NEAR(centreOf(world, 0).y, 1.2, 1e-12);
  // A centre inside of the shape is the place of the body.
  const SceneSpec inside = specOf("bodies: [{shape: {circle: {center: [1, 1.5], radius: 0.1}}}]\n");
  EXPECT_EQ(inside.bodies[0].pose.position, (Vec2{1, 1.5}));
}

TEST(SceneBodies, BodiesThatAreWrongAreRefused) {
  // Truth: one fault each, at its place.
  auto body = [](const std::string& keys) { return "bodies:\n- {position: [1, 1], " + keys + "}\n"; };
  const std::string circle = "shape: {circle: {radius: 0.1}}, ";
  expectFault(body(circle + "density: 0"), {"s.yaml:3:", "density` must be larger than 0"});
  expectFault(body(circle + "density: -2"), {"s.yaml:3:", "density` must be larger than 0"});
  expectFault(body(circle + "mass: 0"), {"s.yaml:3:", "mass` must be larger than 0"});
  expectFault(body(circle + "mass: 1, density: 1"), {"s.yaml:3:", "`mass` and `density` at once"});
  expectFault(body(circle + "bounce: 1.5"), {"s.yaml:3:", "bounce` must be between 0 and 1"});
  expectFault(body(circle + "bounce: -0.1"), {"s.yaml:3:", "bounce` must be between 0 and 1"});
  expectFault(body(circle + "friction: -1"), {"s.yaml:3:", "friction` must be 0 or larger"});
  expectFault(body(circle + "linear_damping: -1"), {"s.yaml:3:", "0 or larger"});
  expectFault(body(circle + "densty: 1"), {"s.yaml:3:", "did you mean `density`?"});
  expectFault(body(circle + "held: true, held_until: 2"), {"s.yaml:3:", "at once"});
  expectFault(body("density: 1"), {"s.yaml:3:3", "`bodies.0.shape` is missing"});
  expectFault(body("shape: {polygon: [[0, 0], [1, 1], [2, 2]]}"), {"s.yaml:3:", "no area"});
  expectFault(body("shape: {polygon: [[0, 0], [1, 1], [1, 0], [0, 1]]}"), {"s.yaml:3:", "crosses"});
  expectFault(body("shape: {circle: {radius: 0}}"), {"s.yaml:3:", "larger than 0"});
  expectFault("bodies: [{name: world, " + circle + "position: [1, 1]}]\n", {"s.yaml:2:17", "`world`"});
  expectFault("bodies: [{name: a.b, " + circle + "position: [1, 1]}]\n", {"s.yaml:2:17", "dot"});
  expectFault("solids: [{name: a, " + circle + "position: [2, 1]}]\nbodies: [{name: a, " + circle +
                  "position: [1, 1]}]\n",
              {"s.yaml:3:17", "a second thing named `a`"});
}

TEST(SceneBodies, NamesStandForOneOrForAllCopies) {
  // Truth: `r` is copies 0 to 2, `r.1` the second of them, and what comes after is counted on.
  const std::string row =
      "bodies:\n- {name: a, shape: {circle: {radius: 0.1}}, position: [0.2, 1.5]}\n"
      "- {name: r, shape: {circle: {radius: 0.1}}, position: [0.2, 1], repeat: {grid: [3, 1], spacing: [0.5, "
      "1]}}\n- {shape: {circle: {radius: 0.1}}, position: [3, 1.5]}\n";
  const SceneSpec spec = specOf(row +
                                "springs: [{from: {body: r.1}, to: {body: body 3}, stiffness: 1}]\n"
                                "events: [{at: 1, hold: r}, {at: 2, hold: [r.2, a]}]\n");
  EXPECT_EQ(spec.springs[0].from.index, 2);
  EXPECT_EQ(spec.springs[0].to.index, 4);
  EXPECT_EQ(std::get<HoldAction>(spec.events[0].action).what.bodies, (std::vector<int>{1, 2, 3}));
  EXPECT_EQ(std::get<HoldAction>(spec.events[1].action).what.bodies, (std::vector<int>{3, 0}));
  expectFault(row + "springs: [{from: {body: r}, to: {body: a}, stiffness: 1}]\n",
              {"`r` stands for 3 copies; name one of them", "r.0 to r.2"});
}

TEST(SceneBodies, PartsOfWhatIsWrongAreNotReportedToo) {
  // Truth: the fault itself and nothing that follows from it, though its copies and particles are not known.
  expectFault(
      "bodies:\n- {name: a, shape: {circle: {radius: 0.1}}, position: [0.2, 1.5]}\n"
      "- {name: r, shape: {circle: {radius: -1}}, position: [0.2, 1], repeat: {grid: [3, 1], spacing: [1, "
      "1]}}\n"
      "springs: [{from: {body: r.1}, to: {body: a}, stiffness: 1}]\njoints: [{weld: [r.2, a]}]\n"
      "events: [{at: 1, hold: r.0}, {at: 2, impulse: {body: r.0, value: [1, 0]}}, {at: 3, hide: r.0}]\n",
      {"s.yaml:4:", "larger than 0"});
  expectFault(kBall +
                  "cloth: [{name: sheet, corner: [0, 0], size: [1, 1], cells: [0, 3]}]\n"
                  "springs: [{from: {body: sheet.3.3}, to: {body: ball}, stiffness: 1}]\n"
                  "events: [{at: 1, release: sheet.2.2}]\n",
              {"s.yaml:3:", "cloth.0.cells.0"});
  // And of what is right, they are.
  EXPECT_NE(problemsOf(kBall + "events: [{at: 1, hold: ball.0}]\n").find("ball.0"), std::string::npos);
}

TEST(SceneBodies, ManyNamesAreReadAsQuicklyAsFew) {
  // Truth: a body of 8,000 takes as long to read as one of 1,000, but for what memory costs.
  const auto secondsEach = [](int count) {
    std::string text = kDomain + "bodies:\n";
    for (int k = 0; k < count; ++k)
      text += "- {name: number " + std::to_string(k) + ", shape: {circle: {radius: 0.001}}, position: [" +
              std::to_string(0.01 + 0.04 * (k % 99)) + ", " + std::to_string(0.01 + 0.02 * (k / 99)) + "]}\n";
    double least = 1e9;
    for (int time = 0; time < 3; ++time) {
      const std::clock_t start = std::clock();
      EXPECT_EQ(SceneDocument::parse(text, "s.yaml").spec().bodies.size(), static_cast<std::size_t>(count));
      least = std::min(least, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC / count);
    }
    return least;
  };
  const double few = secondsEach(1000), many = secondsEach(8000);
  EXPECT_LT(many, 1.6 * few);
}

TEST(SceneBodies, CopiesOutsideAreToldOnce) {
  // Truth: of twelve copies in a row of 4 m, those at 4.2 to 5.7 m are outside: one message, with their
  // number.
  expectFault(
      "bodies: [{name: r, shape: {circle: {radius: 0.1}}, position: [0.2, 1], repeat: {grid: [12, 1], "
      "spacing: [0.5, 1]}}]\n",
      {"s.yaml:2:10: `r.8` and 3 more of its copies start outside of the domain"});
}

TEST(SceneBodies, SizesBeyondReckoningAreTold) {
  // Truth: nothing can be reckoned with a body of 1e-300 m, or of 1e200 m, or of 1e300 kg.
  auto of = [](const std::string& what) {
    return "bodies: [{name: a, shape: {circle: {radius: " + what + "}}, position: [1, 1]}]\n";
  };
  expectFault(of("1e-300"), {"s.yaml:2:10: `a` is too small for this domain"});
  EXPECT_NE(problemsOf(of("1e200")).find("`a` is too large for this domain: 2e+200 m across"),
            std::string::npos);
  expectFault("bodies: [{name: a, shape: {circle: {radius: 0.1}}, position: [1, 1], mass: 1e300}]\n",
              {"`a` has a mass beyond reckoning"});
}

TEST(SceneBodies, WhatIsAddedAgainAndAgainDiffers) {
  // Truth: each time an event adds a row, its shapes, places and colours are other ones; a shorter film has
  // the same first ones.
  auto rows = [](const std::string& until) {
    return specOf(
        "time: {duration: 4}\nevents: [{every: 1, until: " + until +
        ", add: {body: {name: r, position: [0.5, 1], repeat: {grid: [6, 1], spacing: [0.5, 0.5], jitter: "
        "0.2, "
        "shapes: [{circle: {radius: 0.05}}, {box: {size: [0.1, 0.1]}}], colors: [red, blue]}}}}]\n");
  };
  const SceneSpec two = rows("1.5"), three = rows("2.5");
  ASSERT_EQ(two.bodies.size(), 12u);
  ASSERT_EQ(three.bodies.size(), 18u);
  int alike = 0;
  for (int k = 0; k < 6; ++k) alike += two.bodies[k].pose == two.bodies[k + 6].pose;
  EXPECT_EQ(alike, 0);
  for (int k = 0; k < 12; ++k) EXPECT_EQ(two.bodies[k].pose, three.bodies[k].pose) << k;
}

TEST(SceneBodies, CaptionsMayStandAtTheTop) {
  // Truth: bottom unless `side` says top; anything else is refused.
  EXPECT_FALSE(specOf("view: {layers: [caption]}\n").view.layers.at(0).atTop);
  EXPECT_TRUE(specOf("view: {layers: [{caption: {side: top}}]}\n").view.layers.at(0).atTop);
  expectFault("view: {layers: [{caption: {side: left}}]}\n",
              {"s.yaml:2:34: `view.layers.0.caption.side` must be top or bottom"});
  EXPECT_EQ((*specOf("view: {layers: [{springs: {range: [-2, 3]}}]}\n").view.layers.at(0).range)[1], 3);
}

TEST(SceneBodies, PlacesThatCannotBeAreTold) {
  // Truth: an error for what is out of the domain; a warning for what overlaps, and none for what touches.
  auto at = [](const std::string& name, const std::string& place) {
    return "- {name: " + name + ", shape: {box: {size: [0.2, 0.2]}}, position: " + place + "}\n";
  };
  expectFault("bodies:\n" + at("a", "[5, 1]"), {"s.yaml:3:3: `a` starts outside of the domain"});
  expectFault("bodies:\n" + at("a", "[1, -0.2]"), {"s.yaml:3:3: `a` starts outside of the domain"});
  expectFault("bodies:\n" + at("a", "[1, 0.05]"), {"s.yaml:3:3: warning: `a` starts in the bottom wall"});
  EXPECT_EQ(problemsOf("walls: {bottom: open}\nbodies:\n" + at("a", "[1, 0.05]")), "");
  const std::string cloth = "cloth: [{name: s, corner: [3.5, 1], size: [1, 0.5], cells: [4, 4]}]\n";
  expectFault(cloth, {"s.yaml:2:9: warning: `s` starts in the right wall", "not pinned"});
  EXPECT_EQ(problemsOf("walls: {right: open}\n" + cloth), "");
  expectFault("bodies:\n" + at("a", "[1, 1]") + at("b", "[1.1, 1.1]"),
              {"s.yaml:4:3: warning: `a` and `b` start inside of each other", "part gently"});
  expectFault(
      "bodies:\n" + at("a", "[1, 1]") + "- {name: b, shape: {circle: {radius: 0.5}}, position: [1, 1]}\n",
      {"s.yaml:4:3: warning: `a` and `b` start inside"});
  expectFault("bodies:\n" + at("a", "[1, 1]") + "solids:\n" + at("b", "[1.1, 1.1]"),
              {"s.yaml:3:3: warning: `a` and `b` start inside"});
  std::string stack = "bodies:\n";
  for (int k = 0; k < 9; ++k)
    stack += at("b" + std::to_string(k), "[1, 0.1 + " + std::to_string(k) + "*0.2]");
  EXPECT_EQ(problemsOf(stack), "");
  std::string heap = "bodies:\n";
  for (int k = 0; k < 9; ++k) heap += at("b" + std::to_string(k), "[1, 1]");
  const std::string many = problemsOf(heap);
  EXPECT_EQ(std::count(many.begin(), many.end(), '\n'), 8) << many;
  EXPECT_NE(many.find("29 more pairs"), std::string::npos) << many;
}

TEST(SceneBodies, GroupsNeedTwo) {
  // Truth: a group that one body names is a slip; two that share it may overlap.
  const std::string a = "- {name: a, shape: {circle: {radius: 0.2}}, position: [1, 1], ignore: [g]}\n";
  expectFault("bodies:\n" + a, {"s.yaml:3:3: warning: `a` is the only one in the group `g`"});
  EXPECT_EQ(problemsOf("bodies:\n" + a +
                       "- {name: b, shape: {circle: {radius: 0.2}}, position: [1.1, 1], ignore: g}\n"),
            "");
}

TEST(SceneBodies, CopiesFillABlock) {
  // Truth: rows from the lower left, each within its share of the spacing, the same for the same seed.
  auto block = [](const std::string& seed) {
    return specOf(
        "bodies:\n- {name: rain, position: [0.5, 0.5], repeat: {grid: [10, 5], spacing: [0.2, 0.25], jitter: "
        "0.1, turn: 45, seed: " +
        seed + ", shapes: [{box: {size: [0.1, 0.05]}}, {circle: {radius: 0.04}}], colors: [red, blue]}}\n");
  };
  const SceneSpec spec = block("1"), same = block("1"), other = block("2");
  ASSERT_EQ(spec.bodies.size(), 50u);
  int circles = 0, moved = 0;
  for (int k = 0; k < 50; ++k) {
    const BodySpec& body = spec.bodies[k];
    EXPECT_EQ(body.name, "rain." + std::to_string(k));
    EXPECT_EQ(body.family, "rain");
    EXPECT_NEAR(body.pose.position.x, 0.5 + k % 10 * 0.2, 0.02 + 1e-12);
    EXPECT_NEAR(body.pose.position.y, 0.5 + k / 10 * 0.25, 0.025 + 1e-12);
    EXPECT_LE(std::fabs(body.pose.angleRad), kPi / 4);
    EXPECT_TRUE(body.pose == same.bodies[k].pose);
    moved += !(body.pose == other.bodies[k].pose);
    circles += std::holds_alternative<CircleShape>(*body.shape);
  }
  EXPECT_GT(moved, 45);
  EXPECT_GT(circles, 10);
  EXPECT_LT(circles, 40);
  // All copies of a kind share one shape.
  std::vector<const Shape*> shapes;
  for (const BodySpec& body : spec.bodies) shapes.push_back(body.shape.get());
  std::sort(shapes.begin(), shapes.end());
  EXPECT_EQ(std::unique(shapes.begin(), shapes.end()) - shapes.begin(), 2);
}

TEST(SceneBodies, BlocksThatAreWrongAreRefused) {
  // Truth: a grid or spacing that is missing, and more copies than can be.
  auto block = [](const std::string& keys) {
    return "bodies: [{shape: {circle: {radius: 0.01}}, position: [1, 1], repeat: {" + keys + "}}]\n";
  };
  expectFault(block("spacing: [1, 1]"), {"s.yaml:2:", "repeat.grid` is missing"});
  expectFault(block("grid: [2, 2]"), {"s.yaml:2:", "repeat.spacing` is missing"});
  expectFault(block("grid: [0, 2], spacing: [1, 1]"), {"s.yaml:2:", "whole number"});
  expectFault(block("grid: [1000, 1000], spacing: [1, 1]"), {"s.yaml:2:", "200000"});
  expectFault(block("grid: [2, 2], spacing: [0.1, 0.1], jitter: 2"), {"s.yaml:2:", "between 0 and 1"});
}

TEST(SceneBodies, ParticlesAreDisksOfAMass) {
  // Truth: what stands in the text, after the bodies; blocks as bodies have them.
  const SceneSpec spec = specOf(
      "particles:\n- {position: [1, 1], mass: 0.5, radius: 0.02, velocity: [0, 1], bounce: 0.5}\n"
      "- {name: dust, position: [0.1, 0.1], repeat: {grid: [4, 3], spacing: [0.1, 0.1]}}\n" +
      kBall);
  ASSERT_EQ(spec.bodies.size(), 14u);
  EXPECT_FALSE(spec.bodies[0].particle);
  EXPECT_TRUE(spec.bodies[1].particle);
  EXPECT_EQ(spec.bodies[1].name, "particle 1");
  EXPECT_EQ(spec.bodies[1].mass, 0.5);
  EXPECT_EQ(std::get<CircleShape>(*spec.bodies[1].shape).radius, 0.02);
  EXPECT_EQ(spec.bodies[13].name, "dust.11");
  expectFault("particles: [{mass: 1}]\n", {"s.yaml:2:13", "`particles.0.position` is missing"});
  expectFault("particles: [{position: [1, 1], mass: 0}]\n", {"s.yaml:2:38", "larger than 0"});
  expectFault("particles: [{position: [1, 1], spin: 1}]\n", {"s.yaml:2:32", "unknown key `spin`"});
}

TEST(SceneBodies, SpringsJoinPoints) {
  // Truth: bodies in their own coordinates, the world in its own; a length that is left out is that at the
  // start.
  const SceneSpec spec =
      specOf(kTwo +
             "springs:\n- {name: s, from: {body: ball, at: [0, 0.1]}, to: {point: [2, 2]}, length: "
             "0.3, stiffness: 40, damping: 0.5}\n"
             "- {from: {body: ball}, to: {body: arm, at: [-0.2, 0]}, stiffness: 1}\n");
  ASSERT_EQ(spec.springs.size(), 2u);
  const SpringSpec& s = spec.springs[0];
  EXPECT_EQ(s.from.of, HoldSpec::Of::body);
  EXPECT_EQ(s.from.at, (Vec2{0, 0.1}));
  EXPECT_EQ(s.to.of, HoldSpec::Of::world);
  EXPECT_EQ(s.length, 0.3);
  EXPECT_EQ(s.stiffness, 40);
  EXPECT_EQ(s.damping, 0.5);
  EXPECT_FALSE(spec.springs[1].length.has_value());
  EXPECT_EQ(spec.springs[1].to.index, 1);
  EXPECT_EQ(placeAtStart(spec, spec.springs[1].to), (Vec2{1.8, 1}));
}

TEST(SceneBodies, SpringsThatAreWrongAreRefused) {
  // Truth: names that nothing has, ends without a place, no length, nothing that moves.
  auto spring = [](const std::string& keys) { return kTwo + "springs:\n- {" + keys + "}\n"; };
  expectFault(spring("from: {body: bal}, to: {point: [2, 2]}, stiffness: 1"),
              {"s.yaml:6:17: no body, particle or solid is named `bal`", "did you mean `ball`?"});
  expectFault(spring("from: {body: ball}, to: {point: [2, 2]}, stiffness: 1, length: 0"),
              {"s.yaml:6:", "length` must be larger than 0"});
  expectFault(spring("from: {body: ball}, to: {point: [1, 1]}, stiffness: 1"),
              {"s.yaml:6:3: `springs.0` has no length at the start"});
  expectFault(spring("from: {body: ball}, to: {body: ball}, stiffness: 1"), {"the same point"});
  expectFault(spring("from: {point: [0, 0]}, to: {point: [1, 1]}, stiffness: 1"), {"nothing that moves"});
  expectFault(spring("from: {body: ball}, to: {body: world}, stiffness: 1"), {"no place in the world"});
  expectFault(spring("from: {body: ball}, stiffness: 1"), {"`springs.0.to` is missing"});
  expectFault(spring("from: {}, to: {body: ball}, stiffness: 1"), {"either `body` or `point`"});
  expectFault(spring("from: {body: ball}, to: {point: [2, 2]}"), {"`springs.0.stiffness` is missing"});
  expectFault(spring("from: {body: ball}, to: {point: [2, 2]}, stiffness: -1"), {"0 or larger"});
}

TEST(SceneBodies, JointsAreRead) {
  // Truth: kinds, limits in degrees or metres, motors; the axis is made one long.
  const SceneSpec spec = specOf(kTwo +
                                "joints:\n- {name: j, pin: [ball, arm], at: [1.5, 1], limits: [-90, 45], "
                                "motor: {speed: 180, torque: 2}}\n"
                                "- {weld: [world, arm]}\n- {slide: [ball, arm], axis: [0, 2], limits: [-1, "
                                "1], motor: {speed: 1, force: 3}}\n"
                                "- {rope: [ball, world], to: [1, 2], length: 1.5}\n- {rope: [ball, arm]}\n");
  ASSERT_EQ(spec.joints.size(), 5u);
  using Kind = JointSpec::Kind;
  EXPECT_EQ(spec.joints[0].kind, Kind::pin);
  EXPECT_EQ(spec.joints[0].at, (Vec2{1.5, 1}));
  EXPECT_DOUBLE_EQ(spec.joints[0].limits[0], -kPi / 2);
  EXPECT_DOUBLE_EQ(spec.joints[0].limits[1], kPi / 4);
  EXPECT_DOUBLE_EQ(spec.joints[0].motorSpeed, kPi);
  EXPECT_EQ(spec.joints[0].motorLimit, 2);
  EXPECT_EQ(spec.joints[1].kind, Kind::weld);
  EXPECT_EQ(spec.joints[1].a.of, HoldSpec::Of::world);
  EXPECT_EQ(spec.joints[2].axis, (Vec2{0, 1}));
  EXPECT_EQ(spec.joints[2].limits[1], 1);
  EXPECT_EQ(spec.joints[2].motorSpeed, 1);
  EXPECT_EQ(spec.joints[3].length, 1.5);
  EXPECT_EQ(spec.joints[3].to, (Vec2{1, 2}));
  EXPECT_FALSE(spec.joints[4].length.has_value());
}

TEST(SceneBodies, JointsThatAreWrongAreRefused) {
  // Truth: one fault each, at its place.
  auto joint = [](const std::string& keys) { return kTwo + "joints:\n- {" + keys + "}\n"; };
  expectFault(joint("pin: [ball, bar], at: [1, 1]"),
              {"s.yaml:6:16: no body, particle or solid is named `bar`"});
  expectFault(joint("pin: [ball], at: [1, 1]"), {"s.yaml:6:9", "list of 2"});
  expectFault(joint("pin: [ball, arm]"), {"`joints.0.at` is missing"});
  expectFault(joint("pin: [ball, ball], at: [1, 1]"), {"joins a body to itself"});
  expectFault(joint("pin: [world, world], at: [1, 1]"), {"nothing that moves"});
  expectFault(joint("at: [1, 1]"), {"no joint", "pin, weld, slide, rope"});
  expectFault(joint("pin: [ball, arm], weld: [ball, arm], at: [1, 1]"), {"two joints at once"});
  expectFault(joint("pin: [ball, arm], at: [1, 1], limits: [10, -10]"), {"first not above the second"});
  expectFault(joint("pin: [ball, arm], at: [1, 1], limits: [10, 20]"), {"the start, 0"});
  expectFault(joint("pin: [ball, arm], at: [1, 1], motor: {speed: 1, torque: -1}"), {"0 or larger"});
  expectFault(joint("slide: [ball, arm], motor: {speed: 1, force: 1, torque: 1}"), {"unknown key `torque`"});
  expectFault(joint("weld: [ball, arm], limits: [0, 1]"), {"unknown key `limits`"});
  expectFault(joint("slide: [ball, arm], axis: [0, 0]"), {"no direction"});
  expectFault(joint("rope: [ball, world]"), {"`joints.0.to` is missing"});
  expectFault(joint("rope: [ball, arm], length: 0.5"), {"warning", "too short"});
}

TEST(SceneBodies, PlacesOfJointsThatNoBodyCanBeNearAreTold) {
  // Truth: beyond ten times the domain there is a warning at the place, and none for a long pendulum's pivot.
  expectFault(kBall + "joints: [{pin: [world, ball], at: [1000, 1]}]\n",
              {"s.yaml:3:35: warning: `joints.0.at` is far outside of the domain"});
  expectFault(kBall + "joints: [{rope: [world, ball], from: [1, -400]}]\n",
              {"s.yaml:3:38: warning: `joints.0.from` is far"});
  EXPECT_EQ(problemsOf(kBall + "joints: [{pin: [world, ball], at: [1, 30]}]\n"), "");
}

TEST(SceneBodies, ClothIsRead) {
  // Truth: what stands in the text, and where its particles are; pins of each kind.
  const std::string sheet =
      "cloth:\n- {name: sheet, corner: [0.5, 0.4], size: [1, 0.6], cells: [4, 2], mass: 0.05, ";
  const ClothSpec cloth = specOf(sheet + "stiffness: 200, pinned: top, tear: 0.5}\n").cloths.at(0);
  EXPECT_EQ(cloth.columns(), 5);
  EXPECT_EQ(cloth.rows(), 3);
  EXPECT_EQ(cloth.nodeAt(0), (Vec2{0.5, 0.4}));
  EXPECT_EQ(cloth.nodeAt(14), (Vec2{1.5, 1}));
  EXPECT_EQ(cloth.pinned, (std::vector<int>{10, 11, 12, 13, 14}));
  EXPECT_EQ(cloth.shear, 100);
  EXPECT_EQ(cloth.radius, 0.125);
  EXPECT_EQ(cloth.tear, 0.5);
  auto pins = [&](const std::string& pinned) {
    return specOf(sheet + "pinned: " + pinned + "}\n").cloths.at(0).pinned;
  };
  EXPECT_EQ(pins("corners"), (std::vector<int>{0, 4, 10, 14}));
  EXPECT_EQ(pins("top-corners"), (std::vector<int>{10, 14}));
  EXPECT_EQ(pins("left"), (std::vector<int>{0, 5, 10}));
  EXPECT_EQ(pins("[1, 2]"), (std::vector<int>{11}));
  EXPECT_EQ(pins("[[0, 0], right]"), (std::vector<int>{0, 4, 9, 14}));
  EXPECT_EQ(pins("none"), std::vector<int>{});
  expectFault(sheet + "pinned: tpo}\n", {"s.yaml:3:", "must be a side or a particle"});
  expectFault(sheet + "pinned: [[5, 0]]}\n", {"s.yaml:3:", "between 0 and 4"});
  expectFault(sheet + "stiffness: 0}\n", {"s.yaml:3:", "larger than 0"});
  expectFault(sheet + "tear: 0}\n", {"s.yaml:3:", "larger than 0"});
  expectFault("cloth: [{corner: [9, 9], size: [1, 1], cells: [2, 2]}]\n", {"outside of the domain"});
}

TEST(SceneBodies, AParticleOfAClothCanBeHeldByASpring) {
  // Truth: named by column and row; others are told what there is.
  const std::string sheet = kBall + "cloth: [{name: sheet, corner: [2, 1], size: [1, 0.6], cells: [4, 2]}]\n";
  const SceneSpec spec =
      specOf(sheet + "springs: [{from: {body: sheet.4.1}, to: {body: ball}, stiffness: 1}]\n");
  EXPECT_EQ(spec.springs[0].from.of, HoldSpec::Of::cloth);
  EXPECT_EQ(spec.springs[0].from.node, 9);
  expectFault(sheet + "springs: [{from: {body: sheet.5.1}, to: {body: ball}, stiffness: 1}]\n",
              {"sheet.0.0 to sheet.4.2"});
  expectFault(sheet + "springs: [{from: {body: sheet}, to: {body: ball}, stiffness: 1}]\n",
              {"is a cloth", "sheet.0.0 to sheet.4.2"});
}

TEST(SceneBodies, EventsActOnParticlesOfACloth) {
  const std::string sheet =
      kBall + "cloth: [{name: sheet, corner: [2, 0.5], size: [1, 1], cells: [4, 2]}]\nevents:\n";
  const SceneSpec spec = specOf(sheet +
                                "- {at: 1, impulse: {body: sheet.4.1, value: [1, 0]}}\n"
                                "- {at: 2, hold: [sheet.0.2, ball, sheet]}\n- {at: 3, remove: sheet.2.1}\n");
  using Node = Movables::Node;
  EXPECT_EQ(std::get<ImpulseAction>(spec.events[0].action).on.nodes, (std::vector{Node{0, 9}}));
  EXPECT_EQ(std::get<HoldAction>(spec.events[1].action).what.nodes, (std::vector{Node{0, 10}}));
  EXPECT_EQ(std::get<HoldAction>(spec.events[1].action).what.bodies, std::vector<int>{0});
  EXPECT_EQ(std::get<HoldAction>(spec.events[1].action).what.cloths, std::vector<int>{0});
  EXPECT_EQ(std::get<RemoveAction>(spec.events[2].action).what.nodes, (std::vector{Node{0, 7}}));
  expectFault(sheet + "- {at: 1, hold: sheet.5.1}\n", {"s.yaml:5:", "sheet.0.0 to sheet.4.2"});
}

TEST(SceneBodies, EventsActOnBodies) {
  // Truth: actions with the bodies that their names stand for; an added body is absent until then.
  const SceneSpec spec =
      specOf(kTwo +
             "springs: [{name: s, from: {body: ball}, to: {body: arm}, stiffness: 1}]\n"
             "joints: [{name: j, weld: [ball, arm]}]\n"
             "events:\n- {at: 1, impulse: {body: ball, value: [0, 2], at: [0.1, 0]}}\n"
             "- {at: 2, pull: {body: arm, at: [0.2, 0], to: [3, \"1 + t\"], stiffness: 20, for: 1}}\n"
             "- {at: 3, hold: [ball, arm]}\n- {at: 4, release: ball}\n- {at: 5, remove: late}\n"
             "- {at: 4, add: {body: {name: late, shape: {circle: {radius: 0.1}}, position: [3, 1]}}}\n"
             "- {at: 6, cut: [s, j]}\n- {at: 6, hide: ball}\n"
             "- {every: 1, until: 3, add: {particle: {name: drop, position: [3, 1.5]}}}\n");
  ASSERT_EQ(spec.bodies.size(), 7u);
  EXPECT_TRUE(spec.bodies[2].later);
  EXPECT_EQ(spec.bodies[3].name, "drop.0");
  EXPECT_EQ(spec.bodies[6].name, "drop.3");
  ASSERT_EQ(spec.events.size(), 9u);
  const auto& impulse = std::get<ImpulseAction>(spec.events[0].action);
  EXPECT_EQ(impulse.on.bodies, std::vector<int>{0});
  EXPECT_EQ(impulse.value, (Vec2{0, 2}));
  EXPECT_EQ(impulse.at, (Vec2{0.1, 0}));
  const auto& pull = std::get<PullAction>(spec.events[1].action);
  EXPECT_EQ(pull.from.index, 1);
  EXPECT_EQ(pull.to[1](0, 0, 2), 3);
  EXPECT_EQ(pull.duration, 1);
  EXPECT_EQ(std::get<HoldAction>(spec.events[2].action).what.bodies, (std::vector<int>{0, 1}));
  EXPECT_FALSE(std::get<HoldAction>(spec.events[3].action).held);
  EXPECT_EQ(std::get<RemoveAction>(spec.events[4].action).what.bodies, std::vector<int>{2});
  EXPECT_EQ(std::get<AddAction>(spec.events[5].action).first, 2);
  EXPECT_EQ(std::get<CutAction>(spec.events[6].action).springs, std::vector<int>{0});
  EXPECT_EQ(std::get<CutAction>(spec.events[6].action).joints, std::vector<int>{0});
  EXPECT_EQ(std::get<VisibilityAction>(spec.events[7].action).name, "ball");
  EXPECT_EQ(std::get<AddAction>(spec.events[8].action).first, 3);
  EXPECT_EQ(std::get<AddAction>(spec.events[8].action).count, 1);
}

TEST(SceneBodies, EventsThatAreWrongAreRefused) {
  // Truth: one fault each, at its place.
  auto event = [](const std::string& action) { return kTwo + "events:\n- {at: 1, " + action + "}\n"; };
  expectFault(event("impulse: {body: bal, value: [0, 1]}"), {"s.yaml:6:27", "did you mean `ball`?"});
  expectFault(event("impulse: {body: ball}"), {"`events.0.impulse.value` is missing"});
  expectFault(event("pull: {body: ball, stiffness: 1}"), {"`events.0.pull.to` is missing"});
  expectFault(event("pull: {body: ball, to: [x, 1], stiffness: 1}"), {"s.yaml:6:", "events.0.pull.to.0"});
  expectFault(event("hold: [ball, am]"), {"s.yaml:6:24", "did you mean `arm`?"});
  expectFault(event("remove: 3"), {"s.yaml:6:", "is named `3`"});
  expectFault(event("cut: s"), {"s.yaml:6:16: no spring and no joint is named `s`"});
  expectFault(event("add: {}"), {"either `body` or `particle`"});
  expectFault(event("add: {body: {name: ball, shape: {circle: {radius: 0.1}}, position: [3, 1]}}"),
              {"a second thing named `ball`"});
  expectFault(event("add: {body: {shape: {circle: {radius: 0.1}}, position: [9, 1]}}"),
              {"s.yaml:6:3", "outside of the domain"});
  expectFault(event("add: {body: {shape: {circle: {radius: -1}}, position: [3, 1]}}"), {"larger than 0"});
  expectFault(event("set: {bodies.ball.shape: {circle: {radius: 1}}}"), {"cannot change during a run"});
  expectFault(event("set: {bodies.ball.bounce: 2}"), {"setting `bodies.ball.bounce`", "between 0 and 1"});
  expectFault(event("set: {bodies.bal.velocity: [1, 0]}"), {"did you mean `ball`?"});
  expectFault("events: [{at: 1, set: {bodies.ball.velocity: [1, 0]}}]\n",
              {"s.yaml:2:24", "the scene has no list `bodies`"});
  EXPECT_EQ(problemsOf(event("set: {bodies.ball.velocity: [1, 0]}")), "");
  const std::string added =
      "events: [{at: 1, add: {body: {name: late, shape: {circle: {radius: 0.1}}, position: [3, 1]}}}]\n";
  expectFault(added + "joints: [{weld: [world, late]}]\n", {"no body, particle or solid is named `late`"});
}

TEST(SceneBodies, LayersByDefaultShowWhatThereIs) {
  // Truth: what a scene names is drawn, also when a setting reaches one of these layers.
  auto kinds = [](const SceneSpec& spec) {
    std::vector<std::string> names;
    for (const LayerSpec& layer : spec.view.layers) names.emplace_back(layerName(layer.kind));
    return names;
  };
  const std::vector<std::string> wanted{"smoke", "solids", "bodies", "joints", "caption"};
  const std::string scene = kTwo + "joints: [{weld: [ball, arm]}]\n";
  EXPECT_EQ(kinds(specOf(scene)), wanted);
  SceneDocument document = SceneDocument::parse(kDomain + scene, "s.yaml");
  document.set("view.layers.bodies.mark", "false", {"--set", 0, 0});
  EXPECT_EQ(kinds(document.spec()), wanted);
  EXPECT_FALSE(document.spec().view.layers[2].mark);
  const SceneSpec options = specOf(
      "view: {layers: [{bodies: {opacity: 0.5, mark: false}}, {trails: {length: 2}}, {collisions: {fade: "
      "0.5}}]}\n");
  EXPECT_EQ(options.view.layers[1].length, 2);
  EXPECT_EQ(options.view.layers[2].fade, 0.5);
  expectFault("view: {layers: [{bodies: {length: 1}}]}\n", {"s.yaml:2:", "unknown key `length`"});
}

}  // namespace
}  // namespace smokebox

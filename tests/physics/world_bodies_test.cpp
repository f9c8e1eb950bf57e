// Bodies in a world: what scenes and events say happens to them, in cases whose outcome is known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/maths.h"
#include "world/world.h"

namespace smokebox {
namespace {

const std::string kRoom = "domain: {size: [4, 4], resolution: 32}\ntime: {step: 1/120, duration: 4}\n";
const std::string kGravity = "gravity: [0, -10]\n";

World worldOf(const std::string& yaml, int threads = 1) {
  return World(SceneDocument::parse(kRoom + yaml, "test.yaml"), {.threads = threads, .figures = true});
}

void run(World& world, double seconds) {
  const long steps = std::lround(seconds * 120);
  while (world.stepCount() < steps) world.step();
}

/// Null if it is not there.
const BodyFigures* find(const World& world, const std::string& name) {
  for (const BodyFigures& body : world.figures().bodies)
    if (body.name == name) return &body;
  return nullptr;
}
const BodyFigures& bodyOf(const World& world, const std::string& name) {
  const BodyFigures* body = find(world, name);
  if (!body) throw std::runtime_error("no body " + name);
  return *body;
}

const std::string kBall = "{name: ball, shape: {circle: {radius: 0.1}}, position: [1, 3]";

TEST(WorldBodies, FallFreely) {
  // Truth: a parabola, 1/2 g t^2 below the straight line, and a steady spin; kinetic and potential energy add
  // up.
  World world = worldOf(kGravity + "bodies: [" + kBall + ", mass: 2, velocity: [1, 2], spin: 90}]\n");
  const double before = world.figures().energyBodies + world.figures().energyPotential;
  run(world, 0.5);
  const BodyFigures& ball = bodyOf(world, "ball");
  EXPECT_NEAR(ball.position.x, 1.5, 1e-9);
  EXPECT_NEAR(ball.position.y, 3 + 1 - 1.25, 1e-9);
  EXPECT_NEAR(ball.angleDegrees, 45, 1e-9);
  EXPECT_NEAR(ball.spinDegrees, 90, 1e-9);
  EXPECT_NEAR(world.figures().momentum.x, 2, 1e-9);
  EXPECT_NEAR(world.figures().energyBodies + world.figures().energyPotential, before, 1e-3 * before);
  EXPECT_NEAR(world.figures().angularMomentum,
              2 * cross(ball.position, ball.velocity) + 2 * 0.5 * 0.01 * kPi / 2, 1e-9);
}

TEST(WorldBodies, AreListedByTheirCentreOfMass) {
  // Truth: the triangle's centre of mass is a third of its legs from its right angle; it turns about that.
  World world = worldOf("bodies: [{name: t, shape: {polygon: [[1, 1], [1.3, 1], [1, 1.6]]}, spin: 90}]\n");
  for (const double seconds : {0.0, 1.0}) {
    run(world, seconds);
    EXPECT_NEAR(bodyOf(world, "t").position.x, 1.1, 1e-9);
    EXPECT_NEAR(bodyOf(world, "t").position.y, 1.2, 1e-9);
  }
  EXPECT_NEAR(bodyOf(world, "t").angleDegrees, 90, 1e-9);
}

TEST(WorldBodies, HeldOnesWait) {
  // Truth: held until half a second, it has fallen for as long at one second.
  World world = worldOf(kGravity + "bodies: [" + kBall + ", held_until: 0.5}]\n");
  run(world, 0.5);
  EXPECT_EQ(bodyOf(world, "ball").position, (Vec2{1, 3}));
  run(world, 1);
  EXPECT_NEAR(bodyOf(world, "ball").position.y, 3 - 1.25, 1e-9);
}

TEST(WorldBodies, EventsHoldAndRelease) {
  // Truth: it falls for a quarter of a second, stands for a quarter, and falls from rest.
  World world = worldOf(kGravity + "bodies: [" + kBall +
                        "}]\nevents: [{at: 0.25, hold: ball}, {at: 0.5, release: ball}]\n");
  run(world, 0.5);
  EXPECT_NEAR(bodyOf(world, "ball").position.y, 3 - 0.3125, 1e-9);
  run(world, 0.75);
  EXPECT_LT(bodyOf(world, "ball").position.y, 3 - 0.3125 - 0.3);
}

TEST(WorldBodies, AnImpulseTurnsWhatItHitsOffItsCentre) {
  // Truth: 2 N s on 4 kg give 0.5 m/s; 0.1 m off the centre they turn a disk of 0.02 kg m^2 by 10 rad/s.
  World world = worldOf("bodies: [" + kBall + ", mass: 4}]\n" +
                        "events: [{at: 0.5, impulse: {body: ball, at: [0, 0.1], value: [-2, 0]}}]\n");
  run(world, 1);
  const BodyFigures& ball = bodyOf(world, "ball");
  EXPECT_NEAR(ball.velocity.x, -0.5, 1e-12);
  EXPECT_NEAR(ball.spinDegrees, degrees(10), 1e-9);
  EXPECT_NEAR(ball.position.x, 0.75, 1e-9);
}

TEST(WorldBodies, WhatCanBeSetTakesEffect) {
  // Truth: a velocity and a spin that are set are those from then on; gravity and its share, too.
  World world = worldOf("bodies: [" + kBall +
                        "}]\nevents:\n- {at: 0.5, set: {bodies.ball.velocity: [1, 0], bodies.0.spin: 180}}\n"
                        "- {at: 1, set: {gravity: [0, -10], bodies.ball.gravity_scale: 0.5}}\n"
                        "- {at: 1.5, set: {bodies.ball.gravity_scale: 0, bodies.ball.linear_damping: 1}}\n");
  run(world, 0.5);
  EXPECT_EQ(bodyOf(world, "ball").position, (Vec2{1, 3}));
  run(world, 1);
  EXPECT_NEAR(bodyOf(world, "ball").position.x, 1.5, 1e-9);
  EXPECT_NEAR(bodyOf(world, "ball").angleDegrees, 90, 1e-9);
  run(world, 1.5);
  EXPECT_NEAR(bodyOf(world, "ball").position.y, 3 - 0.625, 0.02);
  const double before = length(bodyOf(world, "ball").velocity);
  run(world, 2.5);
  EXPECT_NEAR(length(bodyOf(world, "ball").velocity), before * std::exp(-1), 0.01 * before);
}

TEST(WorldBodies, ComeAndGo) {
  // Truth: a body is in the figures from when it is added until it is removed; with `every`, one more each
  // time.
  World world = worldOf("bodies: [" + kBall +
                        "}]\nevents:\n- {at: 0.5, remove: ball}\n"
                        "- {at: 1, add: {body: {name: late, shape: {circle: {radius: 0.1}}, position: [2, "
                        "1], velocity: [1, 0]}}}\n"
                        "- {every: 1, from: 1, until: 3, add: {body: {name: drop, shape: {circle: {radius: "
                        "0.1}}, position: [1, 1], "
                        "velocity: [0, 0.5]}}}\n");
  run(world, 0.5);
  EXPECT_NE(find(world, "ball"), nullptr);
  EXPECT_EQ(find(world, "late"), nullptr);
  run(world, 1);
  EXPECT_EQ(find(world, "ball"), nullptr);
  run(world, 2);
  EXPECT_NEAR(bodyOf(world, "late").position.x, 3, 1e-9);
  EXPECT_NEAR(bodyOf(world, "drop.0").position.y, 1.5, 1e-9);
  EXPECT_EQ(find(world, "drop.1"), nullptr);
  run(world, 3.5);
  EXPECT_NEAR(bodyOf(world, "drop.1").position.y, 1.75, 1e-9);
  EXPECT_NEAR(bodyOf(world, "drop.2").position.y, 1.25, 1e-9);
}

TEST(WorldBodies, APullMovesTowardsAScriptedPoint) {
  // Truth: with enough damping the body is where the point is; when the pull is over, it goes on as it went.
  World world =
      worldOf("bodies: [" + kBall +
              ", mass: 1}]\nevents: [{at: 0, pull: {body: ball, to: [\"1 + t\", 3], stiffness: 400, "
              "damping: 40, for: 1}}]\n");
  run(world, 1);
  EXPECT_NEAR(bodyOf(world, "ball").position.x, 2, 0.11);
  EXPECT_NEAR(bodyOf(world, "ball").velocity.x, 1, 0.02);
  const BodyFigures then = bodyOf(world, "ball");
  run(world, 2);
  EXPECT_NEAR(bodyOf(world, "ball").position.x, then.position.x + then.velocity.x, 1e-9);
}

TEST(WorldBodies, SpringsSwingUntilTheyAreCut) {
  // Truth: 1 kg on 100 N/m swings at 10 rad/s; cut at the middle, it flies on at its largest speed, 1 m/s.
  World world = worldOf(
      "bodies: [{name: ball, shape: {circle: {radius: 0.1}}, position: [2.1, 2], mass: 1}]\n"
      "springs: [{name: s, from: {body: ball}, to: {point: [1, 2]}, length: 1, stiffness: 100}]\n"
      "events: [{at: 2 + 0.15*pi, cut: s}]\n");
  run(world, 0.2 * kPi);
  EXPECT_NEAR(bodyOf(world, "ball").position.x, 2.1, 2e-3);
  run(world, 3);
  const double speed = bodyOf(world, "ball").velocity.x;
  run(world, 3.1);
  EXPECT_EQ(bodyOf(world, "ball").velocity.x, speed);
  EXPECT_NEAR(std::fabs(speed), std::fabs(std::sin(10 * (2 + 0.15 * kPi))), 0.1);
}

TEST(WorldBodies, APinnedBodySwingsOnItsCircle) {
  // Truth: the centre of mass stays 0.5 m from the pin, and the pendulum keeps its energy.
  World world = worldOf(kGravity +
                        "bodies: [{name: rod, shape: {box: {size: [1, 0.1]}}, position: [2.5, 3], mass: 1}]\n"
                        "joints: [{pin: [world, rod], at: [2, 3]}]\n");
  const double before = world.figures().energyBodies + world.figures().energyPotential;
  double worst = 0;
  while (world.stepCount() < 240) {
    world.step();
    worst = std::max(worst, std::fabs(length(bodyOf(world, "rod").position - Vec2{2, 3}) - 0.5));
  }
  EXPECT_LT(worst, 1e-4);
  EXPECT_NEAR(world.figures().energyBodies + world.figures().energyPotential, before, 0.05);
}

TEST(WorldBodies, AMotorTurnsAndCanBeSet) {
  // Truth: a motor with torque to spare turns the wheel at its speed, and at another one when that is set.
  World world = worldOf(
      "bodies: [{name: wheel, shape: {circle: {radius: 0.3}}, position: [2, 2], mass: 1}]\n"
      "joints: [{name: axle, pin: [world, wheel], at: [2, 2], motor: {speed: 90, torque: 50}}]\n"
      "events: [{at: 1, set: {joints.axle.motor.speed: -180}}]\n");
  run(world, 1);
  EXPECT_NEAR(bodyOf(world, "wheel").spinDegrees, 90, 1e-3);
  EXPECT_NEAR(bodyOf(world, "wheel").angleDegrees, 90, 1);
  run(world, 2);
  EXPECT_NEAR(bodyOf(world, "wheel").spinDegrees, -180, 1e-3);
}

TEST(WorldBodies, ThoseThatShareAGroupPassThroughEachOther) {
  // Truth: two disks that meet head on go on; without the group they swap their speeds.
  for (const bool share : {true, false}) {
    const std::string group = share ? ", ignore: [g]" : "";
    World world = worldOf(
        "bodies:\n- {name: a, shape: {circle: {radius: 0.1}}, position: [1, 2], velocity: [1, 0], bounce: 1" +
        group +
        "}\n- {name: b, shape: {circle: {radius: 0.1}}, position: [3, 2], velocity: [-1, 0], bounce: 1" +
        group + "}\n");
    run(world, 1.5);
    EXPECT_NEAR(bodyOf(world, "a").velocity.x, share ? 1 : -1, 1e-6);
    EXPECT_NEAR(bodyOf(world, "b").velocity.x, share ? -1 : 1, 1e-6);
  }
}

TEST(WorldBodies, ThoseThatAJointJoinsPassThroughEachOther) {
  // Truth: two bars that overlap at their pin swing freely; when the pin is cut they part, and gently.
  const std::string bars =
      "bodies:\n- {name: a, shape: {box: {size: [1, 0.2]}}, position: [1.5, 2], mass: 1}\n"
      "- {name: b, shape: {box: {size: [1, 0.2]}}, position: [2.3, 2], mass: 1, spin: 90}\n"
      "joints: [{name: j, pin: [a, b], at: [1.9, 2]}]\n";
  World world = worldOf(bars + "events: [{at: 1.9, cut: j}]\n");
  EXPECT_EQ(SceneDocument::parse(kRoom + bars, "t.yaml").problems().size(), 0u);
  world.step();  // the pin takes what of the spin it does not allow
  const double before = world.figures().energyBodies;
  int most = 0;
  while (world.stepCount() < 120) {
    world.step();
    most = std::max(most, world.figures().contacts);
  }
  EXPECT_EQ(most, 0);
  EXPECT_NEAR(world.figures().energyBodies, before, 1e-3 * before);
  run(world, 1.93);
  EXPECT_GT(world.figures().contacts, 0);
  run(world, 4);
  EXPECT_LT(world.figures().overlap, 1e-3);
  EXPECT_LT(world.figures().energyBodies, 1.1 * before);
}

TEST(WorldBodies, RestOnTheFloorAndAreCounted) {
  // Truth: a box comes to rest on the bottom of the domain with two points of contact, and hardly sinks in.
  World world =
      worldOf(kGravity + "bodies: [{name: box, shape: {box: {size: [0.4, 0.2]}}, position: [2, 0.3]}]\n");
  run(world, 2);
  EXPECT_NEAR(bodyOf(world, "box").position.y, 0.1, 1e-3);
  EXPECT_NEAR(length(bodyOf(world, "box").velocity), 0, 1e-6);
  EXPECT_EQ(world.figures().contacts, 2);
  EXPECT_LT(world.figures().overlap, 1e-3);
  EXPECT_GE(world.summary().overlapMax, world.figures().overlap);
}

TEST(WorldBodies, AScriptedSolidCarriesByFriction) {
  // Truth: a box on a belt that moves at 0.5 m/s moves with it; one pushed by a wall that moves, with that.
  World world = worldOf(
      kGravity +
      "solids:\n- {name: belt, shape: {box: {size: [8, 0.2]}}, position: [0.5, 1], motion: {velocity: "
      "[0.5, 0]}}\nbodies: [{name: box, shape: {box: {size: [0.2, 0.2]}}, position: [1, 1.2]}]\n");
  run(world, 2);
  EXPECT_NEAR(bodyOf(world, "box").velocity.x, 0.5, 1e-3);
  World pushed = worldOf(
      "solids:\n- {name: ram, shape: {box: {size: [0.2, 1]}}, position: [0.5, 2], motion: {velocity: [0.5, "
      "0]}}\n"
      "bodies: [{name: box, shape: {box: {size: [0.2, 0.2]}}, position: [1, 2]}]\n");
  run(pushed, 3);
  EXPECT_GE(bodyOf(pushed, "box").position.x, 0.5 + 1.5 + 0.2 - 1e-3);
}

TEST(WorldBodies, AMovingWallCarriesByFriction) {
  // Truth: the floor moves at 1 m/s, and so does in the end what lies on it.
  World world = worldOf("walls: {bottom: {no-slip: [1, 0]}, left: periodic, right: periodic}\n" + kGravity +
                        "bodies: [{name: box, shape: {box: {size: [0.4, 0.2]}}, position: [2, 0.1]}]\n");
  run(world, 2);
  EXPECT_NEAR(bodyOf(world, "box").velocity.x, 1, 1e-3);
}

TEST(WorldBodies, AnEventSetsTheSpeedOfAWallAndOfASolid) {
  // Truth: the box goes along with the floor, at 1 m/s until that is set to -0.5 m/s, and the other one with
  // the solid under it, which sets off when its velocity is set.
  World world = worldOf("walls: {bottom: {no-slip: [1, 0]}, left: periodic, right: periodic}\n" + kGravity +
                        "solids: [{name: raft, shape: {box: {size: [1, 0.2]}}, position: [1, 2]}]\n"
                        "bodies:\n- {name: box, shape: {box: {size: [0.4, 0.2]}}, position: [2, 0.1]}\n"
                        "- {name: rider, shape: {box: {size: [0.4, 0.2]}}, position: [1, 2.2]}\n"
                        "events:\n- {at: 1, set: {walls.bottom.no-slip: [-0.5, 0]}}\n"
                        "- {at: 1, set: {solids.raft.motion.velocity: [0.3, 0.1]}}\n");
  run(world, 1);
  EXPECT_NEAR(bodyOf(world, "box").velocity.x, 1, 1e-9);
  EXPECT_NEAR(bodyOf(world, "rider").velocity.x, 0, 1e-9);
  run(world, 2);
  EXPECT_NEAR(bodyOf(world, "box").velocity.x, -0.5, 1e-9);
  EXPECT_NEAR(bodyOf(world, "rider").velocity.x, 0.3, 1e-9);
  EXPECT_NEAR(bodyOf(world, "rider").velocity.y, 0.1, 1e-6);
}

TEST(WorldBodies, WhatLeavesIsToldOnce) {
  // Truth: through an open bottom the ball falls out of the world: one notice with its name, and no more of
  // it.
  World world = worldOf("walls: {bottom: open}\n" + kGravity + "bodies: [" + kBall + "}]\n");
  int told = 0;
  while (world.stepCount() < 240) {
    world.step();
    for (const std::string& notice : world.takeNotices()) {
      ++told;
      EXPECT_NE(notice.find("`ball` has left the domain"), std::string::npos) << notice;
    }
  }
  EXPECT_EQ(told, 1);
  EXPECT_EQ(find(world, "ball"), nullptr);
  EXPECT_EQ(world.figures().energyBodies, 0);
}

TEST(WorldBodies, AStateThatIsNotFiniteStopsTheRun) {
  // Truth: the step, the body and what to try are named.
  World world = worldOf("bodies: [" + kBall + ", velocity: [1e308, 1e308]}]\n");
  try {
    run(world, 4);
    ADD_FAILURE();
  } catch (const SimulationError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("step "), std::string::npos) << message;
    EXPECT_NE(message.find("`ball`"), std::string::npos) << message;
  }
}

TEST(WorldBodies, ASceneWithoutThemHasNoStage) {
  // Truth: neither a system of bodies nor, without a fluid, a fluid.
  const World solids = worldOf("solids: [{shape: {circle: {radius: 0.1}}, position: [1, 1]}]\n");
  EXPECT_EQ(solids.rigid(), nullptr);
  EXPECT_EQ(solids.bytes(), 0u);
  const World bodies = worldOf("bodies: [" + kBall + "}]\n");
  EXPECT_NE(bodies.rigid(), nullptr);
  EXPECT_EQ(bodies.fluid(), nullptr);
}

TEST(WorldBodies, PartTheFluidAsSolidsDo) {
  // Truth: a body covers as much of the grid as a solid of its shape, and drives the fluid before it as one
  // that moves as it does.
  const std::string box = "shape: {box: {size: [0.8, 0.5]}}, position: [1.5, 2], ";
  World body = worldOf("fluid: {}\nbodies: [{name: box, " + box + "velocity: [0.5, 0]}]\n");
  World solid = worldOf("fluid: {}\nsolids: [{name: box, " + box + "motion: {velocity: [0.5, 0]}}]\n");
  run(body, 0.5);
  run(solid, 0.5);
  double apart = 0, fastest = 0;
  for (int j = 0; j < 32; ++j)
    for (int i = 0; i < 32; ++i) {
      apart =
          std::max<double>(apart, std::fabs(body.boundary().volume(i, j) - solid.boundary().volume(i, j)));
      apart = std::max<double>(apart, std::fabs(body.fluid()->u()(i, j) - solid.fluid()->u()(i, j)));
      fastest = std::max<double>(fastest, std::fabs(body.fluid()->v()(i, j)));
    }
  EXPECT_LT(apart, 1e-3);
  EXPECT_GT(fastest, 0.1);
}

TEST(WorldBodies, ProbesAndTheCameraFollowThem) {
  // Truth: a probe beside a body that turns by 90 degrees is above it then; the camera is where the body is.
  World world = worldOf(
      "bodies: [{name: ball, shape: {circle: {radius: 0.1}}, position: [1, 2], velocity: [1, 0], spin: 90}]\n"
      "probes: [{name: p, at: [1.5, 2], follow: ball}]\n"
      "view: {layers: [probes], camera: {follow: ball, height: 1}}\n");
  run(world, 1);
  Snapshot snapshot;
  world.capture(snapshot);
  EXPECT_NEAR(snapshot.probes.at(0).at.x, 2, 1e-9);
  EXPECT_NEAR(snapshot.probes.at(0).at.y, 2.5, 1e-9);
  ASSERT_TRUE(snapshot.followed.has_value());
  EXPECT_NEAR(snapshot.followed->x, 2, 1e-9);
}

TEST(WorldBodies, ASheetTears) {
  // Truth: pulled apart beyond its strain a cloth loses cells; one that cannot tear keeps them all.
  for (const bool tears : {true, false}) {
    World world = worldOf(
        "cloth: [{name: sheet, corner: [1, 2], size: [1, 1], cells: [6, 6], mass: 0.5, stiffness: 100, "
        "pinned: top" +
        std::string(tears ? ", tear: 0.5" : "") +
        "}]\nevents: [{at: 0, pull: {body: sheet.3.0, to: [1.5, 0.5], stiffness: 2000, damping: 5}}]\n"
        "view: {layers: [cloth]}\n");
    run(world, 2);
    Snapshot snapshot;
    world.capture(snapshot);
    ASSERT_EQ(snapshot.cloths.size(), 1u);
    const ClothPicture& cloth = snapshot.cloths[0];
    EXPECT_EQ(cloth.columns, 7);
    EXPECT_EQ(cloth.positions.size(), 49u);
    const auto torn = std::count(cloth.whole.begin(), cloth.whole.end(), 0);
    EXPECT_EQ(torn > 0, tears);
    EXPECT_NEAR(cloth.positions[48].y, 3, 1e-12);  // pinned
  }
}

TEST(WorldBodies, PicturesHaveWhatTheirLayersShow) {
  // Truth: all of it if the layers are listed, nothing if not; a hidden body is not in the picture.
  const std::string scene =
      kGravity + "bodies:\n- " + kBall +
      "}\n- {name: box, shape: {box: {size: [0.2, 0.2]}}, position: [1, 0.1]}\n"
      "particles: [{position: [2, 1], radius: 0.05}]\n"
      "springs: [{from: {body: ball}, to: {point: [1, 4]}, length: 0.5, stiffness: 3}]\n"
      "joints: [{rope: [world, ball], from: [1, 3.9], length: 1}]\n"
      "cloth: [{corner: [2.5, 2], size: [1, 1], cells: [2, 2], pinned: top}]\n"
      "events: [{at: 0.5, hide: ball}]\n";
  World world = worldOf(
      scene +
      "view: {layers: [bodies, particles, springs, joints, cloth, collisions, {trails: {length: 0.25}}]}\n");
  run(world, 0.5);
  Snapshot snapshot;
  world.capture(snapshot);
  ASSERT_EQ(snapshot.bodies.size(), 2u);
  EXPECT_EQ(snapshot.bodies[0].name, "ball");
  EXPECT_EQ(snapshot.bodies[0].radius, 0.1);
  EXPECT_EQ(snapshot.bodies[0].pose.position, bodyOf(world, "ball").position);
  EXPECT_EQ(snapshot.bodies[1].outlines.at(0).size(), 4u);
  EXPECT_EQ(snapshot.particles.size(), 1u);
  ASSERT_EQ(snapshot.springs.size(), 1u);
  EXPECT_EQ(snapshot.springs[0].to, (Vec2{1, 4}));
  const double stretch = length(snapshot.springs[0].to - snapshot.springs[0].from) - 0.5;
  EXPECT_NEAR(snapshot.springs[0].tension, 3 * stretch, 0.05);
  ASSERT_EQ(snapshot.joints.size(), 1u);
  EXPECT_EQ(snapshot.joints[0].kind, JointSpec::Kind::rope);
  EXPECT_EQ(snapshot.cloths.size(), 1u);
  EXPECT_FALSE(snapshot.touches.empty());  // the box on the floor
  ASSERT_EQ(snapshot.trails.size(), 3u);
  EXPECT_NEAR(snapshot.trails[0].seconds, 0.25, 1e-9);
  EXPECT_EQ(snapshot.trails[0].points.size(), 31u);
  run(world, 0.6);
  world.capture(snapshot);
  EXPECT_EQ(snapshot.bodies.size(), 1u);

  World none = worldOf(scene + "view: {layers: [solids]}\n");
  run(none, 0.5);
  none.capture(snapshot);
  EXPECT_TRUE(snapshot.bodies.empty() && snapshot.particles.empty() && snapshot.springs.empty() &&
              snapshot.joints.empty() && snapshot.cloths.empty() && snapshot.touches.empty() &&
              snapshot.trails.empty());
}

TEST(WorldBodies, ImpactsStayInPicturesForAWhile) {
  // Truth: the ball bounces off the floor once; the touch is in the pictures of the next quarter of a second.
  World world = worldOf(
      "bodies: [{name: ball, shape: {circle: {radius: 0.1}}, position: [1, 0.6], velocity: [0, -1], "
      "bounce: 1}]\nview: {layers: [collisions]}\n");
  Snapshot snapshot;
  run(world, 0.6);
  world.capture(snapshot);
  ASSERT_EQ(snapshot.touches.size(), 1u);
  EXPECT_NEAR(snapshot.touches[0].point.y, 0, 0.01);  // it may be anywhere within the step
  EXPECT_NEAR(snapshot.touches[0].approach, 1, 1e-6);
  EXPECT_NEAR(snapshot.touches[0].age, 0.1, 0.02);
  run(world, 0.9);
  world.capture(snapshot);
  EXPECT_TRUE(snapshot.touches.empty());
}

TEST(WorldBodies, BodiesAcrossAPeriodicSideAreSeenTwice) {
  // Truth: half of the disk is on the left, half on the right.
  World world = worldOf(
      "walls: {left: periodic, right: periodic}\n"
      "bodies: [{name: ball, shape: {circle: {radius: 0.3}}, position: [3.9, 2]}]\n");
  Snapshot snapshot;
  world.capture(snapshot);
  ASSERT_EQ(snapshot.bodies.size(), 2u);
  EXPECT_EQ(snapshot.bodies[0].index, snapshot.bodies[1].index);
  EXPECT_NEAR(std::fabs(snapshot.bodies[0].pose.position.x - snapshot.bodies[1].pose.position.x), 4, 1e-12);
}

TEST(WorldBodies, AreTheSameForAnyNumberOfThreads) {
  // Truth: the fingerprint of the state does not depend on the threads, and does on the bodies.
  const std::string heap =
      kGravity +
      "bodies: [{name: h, position: [1, 0.5], repeat: {grid: [8, 8], spacing: [0.25, 0.25], jitter: 0.1, "
      "turn: "
      "90, shapes: [{box: {size: [0.15, 0.1]}}, {regular: {sides: 5, radius: 0.08}}]}}]\n";
  World one = worldOf(heap), two = worldOf(heap, 2), other = worldOf(kGravity + "bodies: [" + kBall + "}]\n");
  for (World* world : {&one, &two, &other}) run(*world, 1);
  EXPECT_EQ(one.stateHash(), two.stateHash());
  const std::uint64_t before = other.stateHash();
  run(other, 1.1);
  EXPECT_NE(other.stateHash(), before);
}

}  // namespace
}  // namespace smokebox

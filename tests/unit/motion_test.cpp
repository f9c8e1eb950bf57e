#include "scene/motion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/maths.h"

namespace smokebox {
namespace {

const Pose kRest{{3, 1}, 0.5};

MotionScript keyed(bool smooth, bool repeat) {
  MotionScript::Keyframes keyframes;
  keyframes.frames = {{1, {{0, 0}, 0}}, {3, {{2, 4}, 1}}, {4, {{2, 0}, 1}}};
  keyframes.smooth = smooth;
  keyframes.repeat = repeat;
  return MotionScript(keyframes);
}

TEST(Motion, NothingMovesByDefault) {
  // Truth: a solid without a script stays at rest.
  EXPECT_TRUE(MotionScript().isStill());
  EXPECT_EQ(MotionScript().poseAt(7, kRest), kRest);
}

TEST(Motion, SteadyMotionIsLinearInTime) {
  // Truth: position + v t and angle + spin t.
  const MotionScript motion(MotionScript::Steady{{2, -1}, 0.25});
  EXPECT_FALSE(motion.isStill());
  EXPECT_EQ(motion.poseAt(0, kRest), kRest);
  EXPECT_EQ(motion.poseAt(4, kRest), (Pose{{11, -3}, 1.5}));
}

TEST(Motion, KeyframesAreMetAndHeld) {
  // Truth: at a key its pose; half-way the mean; before the first and after the last key these are held.
  const MotionScript motion = keyed(false, false);
  EXPECT_EQ(motion.poseAt(0, kRest), (Pose{{0, 0}, 0}));
  EXPECT_EQ(motion.poseAt(1, kRest), (Pose{{0, 0}, 0}));
  EXPECT_EQ(motion.poseAt(2, kRest), (Pose{{1, 2}, 0.5}));
  EXPECT_EQ(motion.poseAt(3, kRest), (Pose{{2, 4}, 1}));
  EXPECT_EQ(motion.poseAt(3.25, kRest), (Pose{{2, 3}, 1}));
  EXPECT_EQ(motion.poseAt(9, kRest), (Pose{{2, 0}, 1}));
}

TEST(Motion, RepeatedKeyframesHaveThePeriodOfTheirSpan) {
  // Truth: from the first key on the pose at t + 3 s is that at t.
  const MotionScript motion = keyed(false, true);
  for (double t : {1.25, 2.0, 2.75, 3.5}) {
    EXPECT_EQ(motion.poseAt(t + 3, kRest), motion.poseAt(t, kRest)) << t;
    EXPECT_EQ(motion.poseAt(t + 30, kRest), motion.poseAt(t, kRest)) << t;
  }
  EXPECT_EQ(motion.poseAt(0.5, kRest), (Pose{{0, 0}, 0}));
}

TEST(Motion, SmoothKeyframesHaveAContinuousVelocity) {
  // Truth: s^2 (3 - 2 s) meets keys and middles as the line does, and its velocity is 0 at every key from
  // both sides.
  const MotionScript motion = keyed(true, false);
  EXPECT_EQ(motion.poseAt(3, kRest), (Pose{{2, 4}, 1}));
  EXPECT_EQ(motion.poseAt(2, kRest), (Pose{{1, 2}, 0.5}));
  const double d = 1e-5;
  for (double key : {1.0, 3.0, 4.0})
    for (double side : {-d, d}) {
      const Vec2 moved = motion.poseAt(key + side, kRest).position - motion.poseAt(key, kRest).position;
      EXPECT_LT(length(moved) / d, 1e-3) << key;
    }
  const double fastest =
      (motion.poseAt(2 + d, kRest).position.x - motion.poseAt(2 - d, kRest).position.x) / (2 * d);
  EXPECT_NEAR(fastest, 1.5, 1e-6);  // the slope of the ease is 3/2 in the middle, of the line 1 m/s
}

TEST(Motion, FormulasReplaceOnlyWhatTheyName) {
  // Truth: x follows the formula, y and the angle stay; angles are degrees in formulas.
  MotionScript::Formula formula;
  formula.x = Expression::parse("3.6 + 0.2*sin(2*pi*t)", "t");
  EXPECT_NEAR(MotionScript(formula).poseAt(0.25, kRest).position.x, 3.8, 1e-15);
  EXPECT_EQ(MotionScript(formula).poseAt(0.25, kRest).position.y, 1);
  EXPECT_EQ(MotionScript(formula).poseAt(0.25, kRest).angleRad, 0.5);
  MotionScript::Formula turning;
  turning.angleDegrees = Expression::parse("180*t", "t");
  EXPECT_DOUBLE_EQ(MotionScript(turning).poseAt(0.5, kRest).angleRad, kPi / 2);
}

}  // namespace
}  // namespace smokebox

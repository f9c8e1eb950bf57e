// The same result for any number of threads.
#include <gtest/gtest.h>

#include "base/hash.h"
#include "support/rigid_cases.h"
#include "support/rigid_world.h"

namespace smokebox::test {
namespace {

std::uint64_t hashOfBin(int threads, double shift) {
  RigidWorld world(closedBox(12, 60, 0, 0.5), {0, -10}, threads);
  Dice dice(12);
  for (int k = 0; k < 150; ++k) {
    BodyDef def = bodyAt(randomPolygon(dice, k % 3 == 0, 0.4), {0.8 + k % 12 * 0.94, 0.6 + k / 12 * 0.95});
    if (k == 7) def.position.x += shift;
    def.friction = 0.5;
    def.bounce = k < 4 ? 0.5 : 0;  // those that fall first
    def.velocity = {dice.between(-3, 3), dice.between(-3, 3)};
    world.add(def);
  }
  world.steps(120);
  Fnv1a hash;
  world.system.hashInto(hash);
  return hash.value();
}

TEST(RigidSame, ABinIsTheSameToTheBitForAnyNumberOfThreads) {
  // Truth: after 120 steps of 150 bodies the whole state is that of one thread, and of a second run; a bit's
  // difference at the start is another state.
  const std::uint64_t one = hashOfBin(1, 0);
  EXPECT_EQ(hashOfBin(1, 0), one);
  EXPECT_EQ(hashOfBin(2, 0), one);
  EXPECT_NE(hashOfBin(1, 1e-15), one);
}

}  // namespace
}  // namespace smokebox::test

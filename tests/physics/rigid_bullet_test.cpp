// Nothing passes through anything, however fast and thin.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "support/rigid_world.h"

namespace smokebox::test {
namespace {

const auto kWall = BoxShape{{0.02, 4}};
constexpr double kSpeeds[] = {30, 200, 400, 2000};

struct Bullet {
  const char* name;
  std::shared_ptr<const BodyShape> shape;
  double angleRad;
};
const std::vector<Bullet>& bullets() {
  static const std::vector<Bullet> all = {{"disk", bodyShape(CircleShape{0.03}), 0},
                                          {"box", bodyShape(BoxShape{{0.06, 0.06}}), 0.3},
                                          {"rod along", bodyShape(BoxShape{{0.4, 0.01}}), 0},
                                          {"rod across", bodyShape(BoxShape{{0.4, 0.01}}), kPi / 2},
                                          {"rod aslant", bodyShape(BoxShape{{0.4, 0.01}}), 0.7}};
  return all;
}

BodyDef shot(const Bullet& bullet, Vec2 from, double speed, double e) {
  BodyDef def = bodyAt(bullet.shape, from, 1);
  def.angleRad = bullet.angleRad;
  def.velocity.x = speed;
  def.bounce = e;
  return def;
}

std::string what(const Bullet& bullet, double speed, double e, int moment) {
  return std::string(bullet.name) + " at " + std::to_string(speed) + " m/s, bounce " + std::to_string(e) +
         ", moment " + std::to_string(moment);
}

TEST(RigidBullet, NoneGoesThroughAWall) {
  // Truth: a bullet that meets a wall of 2 cm, fixed or free, stays on its side, whatever its shape and
  // speed.
  for (const Bullet& bullet : bullets())
    for (const double speed : kSpeeds)
      for (const double e : {0.0, 0.5, 1.0})
        for (const bool free : {false, true})
          for (int k = 0; k < 8; ++k) {
            RigidWorld world;
            BodyDef plate = free ? bodyAt(bodyShape(kWall), {50, 50}, k % 2 ? 20 : 0.5)
                                 : solidAt(solidShape(kWall), {50, 50});
            plate.inertia *= 100;  // heavy at its ends: it hardly turns, so no bullet can go around it
            const int wall = world.add(plate);
            const int body =
                world.add(shot(bullet, {49.5 - speed * RigidWorld::kStep * k / 8, 50.1}, speed, e));
            for (int step = 0; step < 6; ++step) {
              world.steps(1);
              // In the wall's own coordinates, while the bullet is beside it.
              const Frame frame{world.at(wall), turnBy(world.system.angleRad(wall))};
              const Vec2 there = toLocal(frame, world.at(body));
              if (std::abs(there.y) > 1.9) break;
              EXPECT_LT(there.x, 0) << what(bullet, speed, e, k) << (free ? ", free wall" : ", fixed wall");
              if (there.x >= 0) break;
            }
          }
}

TEST(RigidBullet, TwoHeadOnDoNotPass) {
  // Truth: bullets that meet head-on keep their order; equal ones with bounce 1 exchange their velocities.
  for (Bullet bullet : bullets()) {
    if (bullet.angleRad < 1) bullet.angleRad = 0;  // central: aslant they would slide past each other
    for (const double speed : kSpeeds)
      for (const double e : {0.0, 0.5, 1.0})
        for (int k = 0; k < 8; ++k) {
          RigidWorld world;
          const int a = world.add(shot(bullet, {49.5 - speed * RigidWorld::kStep * k / 8, 50}, speed, e));
          const int b = world.add(shot(bullet, {50.5 + speed * RigidWorld::kStep * k / 8, 50}, -speed, e));
          double apart = 1;
          for (int step = 0; step < 5 && apart > 0; ++step) {
            world.steps(1);
            apart = world.at(b).x - world.at(a).x;
          }
          EXPECT_GT(apart, 0) << what(bullet, speed, e, k);
          EXPECT_NEAR(world.velocity(a).x, -e * speed, (e > 0 ? 1e-6 : 1e-4) * speed)
              << what(bullet, speed, e, k);
        }
  }
}

TEST(RigidBullet, ATurningRodStrikesAThinPost) {
  // Truth: a free rod of 1 m that turns into a post at arm r gets (1 + e) w r / (1/m + r^2/I): at 1 to 200
  // turns a second, the post a fraction of a turn ahead.
  for (const double turns : {1.0, 5.0, 25.0, 60.0, 200.0})
    for (const double far : {0.3, 0.4, 0.47})
      for (const double e : {0.5, 1.0})
        for (const double ahead : {0.05, 0.7, 1.5}) {
          RigidWorld world;
          BodyDef post = solidAt(solidShape(CircleShape{0.01}),
                                 {50 + far * std::cos(ahead), 50 + far * std::sin(ahead)});
          post.bounce = e;
          world.add(post);
          BodyDef rod = bodyAt(bodyShape(BoxShape{{1, 0.02}}), {50, 50}, 1);
          const double w = rod.spin = 2 * kPi * turns;
          const int body = world.add(rod);
          world.steps(static_cast<int>(ahead / w / RigidWorld::kStep) + 1);
          const double r = std::sqrt(far * far - 0.02 * 0.02),
                       j = (1 + e) * w * r / (1 + r * r / rod.inertia);
          EXPECT_NEAR(length(world.velocity(body)), j, 1e-3 * w)
              << turns << " turns/s, arm " << far << ", bounce " << e << ", ahead " << ahead;
          EXPECT_NEAR(world.spin(body), w - r * j / rod.inertia, 2e-3 * w)
              << turns << " turns/s, arm " << far << ", bounce " << e << ", ahead " << ahead;
        }
}

TEST(RigidBullet, ARicochetWithinAStepMeetsTheNextWall) {
  // Truth: off a plate at 45 degrees into a second one across and back: it returns the way that it came.
  for (const double speed : kSpeeds)
    for (const double across : {0.1, 0.3, 1.0})
      for (int k = 0; k < 8; ++k) {
        RigidWorld world;
        BodyDef slant = solidAt(solidShape(kWall), {50, 50}, -kPi / 4);
        BodyDef lid = solidAt(solidShape(BoxShape{{1, 0.02}}), {50, 50.05 + across});
        slant.bounce = lid.bounce = 1;
        world.add(slant);
        world.add(lid);
        const Bullet& disk = bullets()[0];
        const int body = world.add(shot(disk, {49 - speed * RigidWorld::kStep * k / 8, 50}, speed, 1));
        for (int step = 0; step < 40 && world.velocity(body).x > -0.5 * speed; ++step) {
          world.steps(1);
          // Under the lid, on the upper left side of the slant.
          const Vec2 at = world.at(body);
          EXPECT_LT(at.x - at.y, 0) << what(disk, speed, 1, k) << ", across " << across;
          if (at.x > 49) {
            EXPECT_LT(at.y, 50.05 + across) << what(disk, speed, 1, k) << ", across " << across;
          }
        }
        EXPECT_NEAR(world.velocity(body).x, -speed, 1e-3 * speed)
            << what(disk, speed, 1, k) << ", across " << across;
        EXPECT_NEAR(world.velocity(body).y, 0, 1e-3 * speed)
            << what(disk, speed, 1, k) << ", across " << across;
      }
}

TEST(RigidBullet, ABoxIsNotDrivenThroughTheWallBehindIt) {
  // Truth: a box beside a wall of 2 cm that is hit by a bullet stays on its side of the wall.
  for (const double speed : kSpeeds)
    for (const double gap : {0.0, 1e-3, 0.1})
      for (const double e : {0.0, 0.5, 1.0})
        for (const double mass : {0.1, 1.0, 30.0})
          for (int k = 0; k < 4; ++k) {
            RigidWorld world;
            world.add(solidAt(solidShape(kWall), {50, 50}));
            const int box = world.add(bodyAt(bodyShape(BoxShape{{0.5, 0.5}}), {49.74 - gap, 50}, mass));
            const Bullet& disk = bullets()[0];
            const int ball = world.add(shot(disk, {49 - speed * RigidWorld::kStep * k / 4, 50.1}, speed, e));
            for (int step = 0; step < 6; ++step) {
              world.steps(1);
              const Vec2 at = world.at(box), then = world.at(ball);
              if (std::abs(at.y - 50) < 1.5) {
                EXPECT_LT(at.x, 50) << what(disk, speed, e, k) << ", gap " << gap << ", mass " << mass;
              }
              if (std::abs(then.y - 50) < 1.5) {
                EXPECT_LT(then.x, 50)
                    << what(disk, speed, e, k) << ", bullet; gap " << gap << ", mass " << mass;
              }
            }
          }
}

}  // namespace
}  // namespace smokebox::test

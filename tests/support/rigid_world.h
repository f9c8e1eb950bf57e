// Rigid bodies alone, for tests: shapes, bodies and solids in a word each, and steps of 1/60 s.
#pragma once
#include <cmath>
#include <memory>
#include <vector>

#include "base/maths.h"
#include "rigid/system.h"

namespace smokebox::test {

inline std::shared_ptr<const BodyShape> bodyShape(const Shape& shape) {
  Vec2 offset;
  return std::make_shared<BodyShape>(makeBodyShape({shape, {}}, 1e-4, offset));
}
inline std::shared_ptr<const BodyShape> solidShape(const Shape& shape) {
  return std::make_shared<BodyShape>(makeSolidShape({shape, {}}, 1e-4));
}

/// A body of density 1 (or of the mass that is given) at rest, without bounce or friction.
inline BodyDef bodyAt(std::shared_ptr<const BodyShape> shape, Vec2 position, double mass = 0) {
  BodyDef def;
  const MassProperties& unit = shape->mass;
  def.mass = mass > 0 ? mass : unit.area;
  def.inertia = def.mass * unit.secondMoment / unit.area;
  def.shape = std::move(shape);
  def.position = position;
  def.friction = 0;
  return def;
}
/// What nothing moves.
inline BodyDef solidAt(std::shared_ptr<const BodyShape> shape, Vec2 position, double angleRad = 0) {
  BodyDef def;
  def.shape = std::move(shape);
  def.position = position;
  def.angleRad = angleRad;
  def.friction = 0;
  return def;
}

inline RigidWalls wallsOf(RigidWalls::Kind kind, double width, double height, double bounce = 0,
                          double friction = 0) {
  RigidWalls walls;
  walls.width = width, walls.height = height;
  for (RigidWalls::Kind& side : walls.sides) side = kind;
  walls.bounce = bounce, walls.friction = friction;
  return walls;
}
inline RigidWalls noWalls() { return wallsOf(RigidWalls::Kind::open, 100, 100); }
inline RigidWalls closedBox(double width, double height, double bounce = 0, double friction = 0) {
  return wallsOf(RigidWalls::Kind::closed, width, height, bounce, friction);
}

struct RigidWorld {
  static constexpr double kStep = 1.0 / 60;

  explicit RigidWorld(const RigidWalls& walls = noWalls(), Vec2 gravity = {}, int threads = 1)
      : pool(threads), system(walls, gravity, RigidMethod{}, pool) {}

  int add(const BodyDef& def) { return system.add(def); }
  void steps(int count) {
    for (int k = 0; k < count; ++k) system.step(kStep);
  }
  void seconds(double time) { steps(static_cast<int>(std::lround(time / kStep))); }
  Vec2 at(int body) const { return system.position(body); }
  Vec2 velocity(int body) const { return system.velocity(body); }
  double spin(int body) const { return system.spin(body); }

  ThreadPool pool;
  RigidSystem system;
};

}  // namespace smokebox::test

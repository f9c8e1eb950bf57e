// Bodies with springs and joints and nothing else: the sub-steps of the rigid system without contacts.
#pragma once
#include <cmath>

#include "rigid/joint_set.h"
#include "rigid/spring_set.h"

namespace smokebox::test {

inline ThreadPool& oneThread() {
  static ThreadPool pool(1);
  return pool;
}

struct LinksWorld {
  Bodies bodies;
  SpringSet springs{oneThread()};
  JointSet joints;
  Vec2 gravity;
  double drag = 0;  // 1/s, to come to rest
  int sweeps = 1;
  double change = 0;  // of the last sweep

  int add(Vec2 position, double mass, double inertia, Vec2 velocity = {}, double spin = 0, double angle = 0) {
    BodyDef def;
    def.position = position, def.velocity = velocity;
    def.mass = mass, def.inertia = inertia;
    def.angleRad = angle, def.spin = spin;
    bodies.def.push_back(def);
    bodies.velocity.push_back({velocity.x, velocity.y, spin, 0});
    bodies.moved.push_back({});
    bodies.inverse.push_back({mass > 0 ? 1 / mass : 0, inertia > 0 ? 1 / inertia : 0});
    bodies.position.push_back(position);
    bodies.wound.push_back({});
    bodies.angleRad.push_back(angle);
    bodies.turn.push_back(turnBy(angle));
    bodies.there.push_back(1);
    return bodies.count() - 1;
  }
  int particle(Vec2 position, double mass, Vec2 velocity = {}) { return add(position, mass, 0, velocity); }
  /// A uniform rod of length `size`.
  int rod(Vec2 centre, double size, double mass, double angle = 0) {
    return add(centre, mass, mass * size * size / 12, {}, 0, angle);
  }
  int spring(Anchor from, Anchor to, double rest, double stiffness, double damping = 0) {
    SpringDef def;
    def.from = from, def.to = to;
    def.length = rest, def.stiffness = stiffness, def.damping = damping;
    return springs.add(def, bodies);
  }
  int joint(JointKind kind, Anchor a, Anchor b) {
    JointDef def;
    def.kind = kind;
    def.a = a, def.b = b;
    return joints.add(def, bodies);
  }

  void step(double dt, int subSteps = 1) {
    const double h = dt / subSteps;
    joints.beginStep(bodies, dt, subSteps);
    springs.beginStep(bodies, dt, subSteps);
    for (int s = 0; s < subSteps; ++s) {
      for (int k = 0; k < bodies.count(); ++k) {
        if (!bodies.moves(k)) continue;
        Motion& v = bodies.velocity[k];
        const double keep = 1 / (1 + drag * h);
        v = {keep * v.x + h * gravity.x, keep * v.y + h * gravity.y, keep * v.turn, 0};
      }
      joints.warmStart(bodies, h);
      springs.warmStart(bodies, h);
      for (int sweep = 0; sweep < sweeps; ++sweep)
        change = std::max(joints.solve(bodies, h), springs.solve(bodies, h));
      for (int k = 0; k < bodies.count(); ++k) {
        Motion& moved = bodies.moved[k];
        const Motion& v = bodies.velocity[k];
        moved.x += h * v.x, moved.y += h * v.y, moved.turn += h * v.turn;
      }
    }
    joints.endStep(bodies);
    springs.endStep(bodies);
    for (int k = 0; k < bodies.count(); ++k) {
      bodies.position[k] = bodies.positionNow(k);
      bodies.angleRad[k] = bodies.angleNow(k);
      bodies.turn[k] = turnBy(bodies.angleRad[k]);
      bodies.moved[k] = {};
    }
  }

  double kinetic() const {
    double sum = 0;
    for (int k = 0; k < bodies.count(); ++k) {
      const Motion& v = bodies.velocity[k];
      sum +=
          0.5 * bodies.def[k].mass * (v.x * v.x + v.y * v.y) + 0.5 * bodies.def[k].inertia * v.turn * v.turn;
    }
    return sum;
  }
  double potential() const {
    double sum = springs.energy(bodies);
    for (int k = 0; k < bodies.count(); ++k)
      if (bodies.moves(k)) sum -= bodies.def[k].mass * dot(gravity, bodies.positionNow(k));
    return sum;
  }
  /// One step of one sub-step; the energy at its middle, where the velocities are.
  double energyOfStep(double dt) {
    const double before = potential();
    step(dt);
    return kinetic() + 0.5 * (before + potential());
  }
  Vec2 point(const Anchor& anchor) const {
    return anchor.body < 0 ? anchor.at : toWorld(bodies.frameNow(anchor.body), anchor.at);
  }
  /// Largest distance of the anchors of a pin or weld.
  double gap(int joint) const {
    const JointDef& def = joints.def(joint);
    return length(point(def.a) - point(def.b));
  }
};

}  // namespace smokebox::test

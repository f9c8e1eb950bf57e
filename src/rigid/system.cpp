#include "rigid/system.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/hash.h"
#include "rigid/system_state.h"

namespace smokebox {

RigidSystem::RigidSystem(const RigidWalls& walls, Vec2 gravity, const RigidMethod& method, ThreadPool& pool)
    : state_(std::make_unique<State>(walls, gravity, method, pool)) {}
RigidSystem::~RigidSystem() = default;

void RigidSystem::step(double dt) {
  State& s = *state_;
  const double h = dt / s.method.subSteps;
  s.beginStep(dt);
  for (int k = 0; k < s.method.subSteps; ++k) {
    s.predict(h);
    s.bounce(h);
    s.solveContacts(h);
    s.move(h);
  }
  s.endStep(dt);
}

// --- what there is
// ----------------------------------------------------------------------------------------------------------

int RigidSystem::add(const BodyDef& def) {
  State& s = *state_;
  Bodies& bodies = s.bodies;
  const int body = bodies.count();
  bodies.def.push_back(def);
  bodies.extent.push_back(extentOf(*def.shape));
  bodies.velocity.push_back({def.velocity.x, def.velocity.y, def.spin});
  bodies.moved.push_back({});
  bodies.inverse.push_back({});
  bodies.position.push_back(def.position);
  bodies.wound.push_back({});
  bodies.angleRad.push_back(def.angleRad);
  bodies.turn.push_back(turnBy(def.angleRad));
  bodies.there.push_back(1);
  s.resume.push_back({});
  s.fresh.push_back(3);
  s.departed.push_back(0);
  s.targetPlace.push_back(def.position);
  s.targetAngle.push_back(def.angleRad);
  s.ahead.push_back({});
  s.setInverse(body);
  if (def.held) {
    s.resume[body] = bodies.velocity[body];
    bodies.velocity[body] = {};
  }
  return body;
}

void RigidSystem::remove(int body) {
  State& s = *state_;
  s.bodies.there[body] = 0;
  s.bodies.inverse[body] = {};
  s.bodies.velocity[body] = {};
  s.bodies.defsChanged = true;
  s.springs.removeAt(body);
  for (int k = 0; k < s.joints.count(); ++k) {
    const JointDef& joint = s.joints.def(k);
    if (s.joints.isThere(k) && (joint.a.body == body || joint.b.body == body)) s.setJoined(joint, false);
  }
  s.joints.removeAt(body);
}

int RigidSystem::addSpring(const SpringDef& def) { return state_->springs.add(def, state_->bodies); }
int RigidSystem::addJoint(const JointDef& def) {
  state_->setJoined(def, true);
  return state_->joints.add(def, state_->bodies);
}
void RigidSystem::removeSpring(int spring) {
  State& s = *state_;
  if (!s.springs.isThere(spring)) return;
  const std::vector<Motion> was = s.bodies.velocity;
  s.springs.giveHalf(spring, s.bodies);
  // The velocity of now has this half already.
  for (int b = 0; b < s.bodies.count(); ++b) {
    const Motion &v = s.bodies.velocity[b], &w = was[b];
    Motion& to = s.ahead[b];
    to = {to.x - (v.x - w.x), to.y - (v.y - w.y), to.turn - (v.turn - w.turn)};
  }
  s.springs.remove(spring);
}
void RigidSystem::removeJoint(int joint) {
  State& s = *state_;
  if (s.joints.isThere(joint)) s.setJoined(s.joints.def(joint), false);
  s.joints.remove(joint);
}

void RigidSystem::State::setJoined(const JointDef& joint, bool on) {
  if (joint.kind == JointKind::rope || joint.a.body < 0 || joint.b.body < 0) return;
  const std::pair<int, int> pair = std::minmax(joint.a.body, joint.b.body);
  auto& joined = bodies.joined;
  const auto at = std::lower_bound(joined.begin(), joined.end(), pair);
  if (on)
    joined.insert(at, pair);
  else if (at != joined.end() && *at == pair)
    joined.erase(at);
  broad.lookAgain(pair.first);
  broad.lookAgain(pair.second);
}

// --- events and scripts
// ----------------------------------------------------------------------------------------------------------

void RigidSystem::setGravity(Vec2 gravity) { state_->gravity = gravity; }

void RigidSystem::setVelocity(int body, Vec2 velocity) {
  State& s = *state_;
  Motion& v = s.bodies.def[body].held ? s.resume[body] : s.bodies.velocity[body];
  v.x = velocity.x;
  v.y = velocity.y;
  s.ahead[body].x = s.ahead[body].y = 0;
  s.fresh[body] |= 1;
}

void RigidSystem::setSpin(int body, double spin) {
  State& s = *state_;
  (s.bodies.def[body].held ? s.resume[body] : s.bodies.velocity[body]).turn = spin;
  s.ahead[body].turn = 0;
  s.fresh[body] |= 2;
}

void RigidSystem::applyImpulse(int body, Vec2 at, Vec2 impulse) {
  State& s = *state_;
  Motion &v = s.bodies.velocity[body], &ahead = s.ahead[body];
  const Motion was = v;
  s.bodies.push(body, at - s.bodies.positionNow(body), impulse);
  // The velocity of half a sub-step ago that damping makes this one of.
  const auto since = s.fresh[body] ? State::Drive{} : s.halfDrives[body];
  auto grow = [](double before, double& now, double& later, double left) {
    const double more = (now - before) * (1 / std::max(left, 1e-6) - 1);
    now += more;
    later -= more;
  };
  grow(was.x, v.x, ahead.x, since.linear);
  grow(was.y, v.y, ahead.y, since.linear);
  grow(was.turn, v.turn, ahead.turn, since.angular);
}

void RigidSystem::hold(int body) {
  State& s = *state_;
  s.bodies.def[body].held = true;
  s.bodies.velocity[body] = {};
  s.resume[body] = s.ahead[body] = {};
  s.setInverse(body);
}

void RigidSystem::release(int body) {
  State& s = *state_;
  if (!s.bodies.def[body].held) return;
  s.bodies.def[body].held = false;
  s.bodies.velocity[body] = s.resume[body];
  s.fresh[body] = 3;
  s.setInverse(body);
}

void RigidSystem::setSurface(int body, double bounce, double friction) {
  state_->bodies.def[body].bounce = bounce;
  state_->bodies.def[body].friction = friction;
  state_->bodies.defsChanged = true;
}

void RigidSystem::setDamping(int body, double linear, double angular) {
  state_->bodies.def[body].linearDamping = linear;
  state_->bodies.def[body].angularDamping = angular;
  state_->bodies.defsChanged = true;
}

void RigidSystem::setGravityScale(int body, double scale) {
  state_->bodies.def[body].gravityScale = scale;
  state_->bodies.defsChanged = true;
}

void RigidSystem::setMass(int body, double mass, double inertia) {
  state_->bodies.def[body].mass = mass;
  state_->bodies.def[body].inertia = inertia;
  state_->setInverse(body);
}

void RigidSystem::setSpring(int spring, double length, double stiffness, double damping) {
  SpringDef& def = state_->springs.def(spring);
  def.length = length;
  def.stiffness = stiffness;
  def.damping = damping;
}

void RigidSystem::setSpringSlack(int spring, double slack) { state_->springs.def(spring).slack = slack; }

void RigidSystem::setMotor(int joint, double speed, double limit) {
  state_->joints.setMotor(joint, speed, limit);
}

void RigidSystem::setWallSpeed(int side, double speed) {
  Motion& v = state_->bodies.velocity[side];
  (side < 2 ? v.y : v.x) = speed;
}

void RigidSystem::moveTo(int body, Vec2 position, double angleRad) {
  state_->targetPlace[body] = position;
  state_->targetAngle[body] = angleRad;
}

void RigidSystem::moveSpringEnd(int spring, Vec2 to) { state_->springs.moveEnd(spring, to); }

// --- what there is now
// ----------------------------------------------------------------------------------------------------------

int RigidSystem::bodyCount() const { return state_->bodies.count(); }
bool RigidSystem::isThere(int body) const { return body >= State::kWalls && state_->bodies.there[body]; }
const BodyDef& RigidSystem::def(int body) const { return state_->bodies.def[body]; }
Vec2 RigidSystem::position(int body) const { return state_->bodies.position[body]; }
double RigidSystem::angleRad(int body) const { return state_->bodies.angleRad[body]; }
bool RigidSystem::held(int body) const { return state_->bodies.def[body].held; }

// Velocities are kept for the middle of the last sub-step.
Vec2 RigidSystem::velocity(int body) const {
  const State& s = *state_;
  return s.bodies.velocity[body].linear() + s.ahead[body].linear();
}
double RigidSystem::spin(int body) const {
  return state_->bodies.velocity[body].turn + state_->ahead[body].turn;
}

bool RigidSystem::springIsThere(int spring) const { return state_->springs.isThere(spring); }
long RigidSystem::springsRemoved() const { return state_->springs.removed(); }
const SpringDef& RigidSystem::spring(int spring) const { return state_->springs.def(spring); }
double RigidSystem::springTension(int spring) const { return state_->springs.tension(spring); }
bool RigidSystem::jointIsThere(int joint) const { return state_->joints.isThere(joint); }
const JointDef& RigidSystem::joint(int joint) const { return state_->joints.def(joint); }

Vec2 RigidSystem::anchorPoint(const Anchor& anchor) const {
  return anchor.body < 0 ? anchor.at : toWorld(state_->bodies.frameNow(anchor.body), anchor.at);
}

std::array<Vec2, 2> RigidSystem::endsOf(const Anchor& from, const Anchor& to) const {
  const auto wound = [&](const Anchor& end) {
    return end.body < 0 ? Vec2{} : state_->bodies.wound[end.body];
  };
  const Vec2 off = from.body < 0 ? wound(to) : wound(from);
  return {anchorPoint(from) + wound(from) - off, anchorPoint(to) + wound(to) - off};
}

Vec2 RigidSystem::positionBeside(int body, int other) const {
  return position(body) + state_->bodies.wound[body] - state_->bodies.wound[other];
}

const std::vector<Touch>& RigidSystem::touches() const {
  state_->sortTouches();
  return state_->touches;
}

RigidTotals RigidSystem::totals() const {
  const State& s = *state_;
  RigidTotals totals = s.contactTotals;
  for (int b = State::kWalls; b < s.bodies.count(); ++b) {
    const BodyDef& def = s.bodies.def[b];
    if (!s.bodies.there[b] || def.mass <= 0) continue;
    const Vec2 v = velocity(b), x = position(b);
    const double w = spin(b);
    totals.momentum = totals.momentum + def.mass * v;
    totals.angularMomentum += def.mass * cross(x, v) + def.inertia * w;
    totals.kineticEnergy += 0.5 * (def.mass * dot(v, v) + def.inertia * w * w);
    totals.potentialEnergy -= def.mass * def.gravityScale * dot(s.gravity, x);
  }
  totals.potentialEnergy += s.springs.energy(s.bodies);
  return totals;
}

std::vector<int> RigidSystem::takeDeparted() { return std::exchange(state_->gone, {}); }

void RigidSystem::hashInto(Fnv1a& hash) const {
  const Bodies& bodies = state_->bodies;
  for (int b = 0; b < bodies.count(); ++b) {
    hash.update(&bodies.there[b], 1);
    hash.update(&bodies.position[b], sizeof(Vec2));
    hash.update(&bodies.wound[b], sizeof(Vec2));
    hash.update(&bodies.angleRad[b], sizeof(double));
    hash.update(&bodies.velocity[b], sizeof(Motion));
  }
}

std::size_t RigidSystem::bytes() const {
  const State& s = *state_;
  return s.bodies.def.capacity() * (sizeof(BodyDef) + 6 * sizeof(Motion)) + s.narrow.bytes() +
         s.blocks.bytes();
}

}  // namespace smokebox

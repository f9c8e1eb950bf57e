// The stages of a step of bodies.
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/errors.h"
#include "base/maths.h"
#include "rigid/contact_sweeps.h"
#include "rigid/lanes.h"
#include "rigid/system_state.h"

namespace smokebox {

namespace {
// Approaches slower than what gravity adds in so many sub-steps do not bounce.
constexpr double kRestingSubSteps = 2;
// Contacts that overlap by more than this share of the thinner one's width do not bounce.
constexpr double kSqueezed = 0.01;
// Contacts are rough where sweeps leave more undone than this share of what gravity adds in a sub-step.
constexpr double kUnsettled = 0.2;
// What changes a velocity by more than gravity does in so many sub-steps may be a blow.
constexpr double kForce = 4;
// What is so many domains beyond an open side does not come back within a film.
constexpr double kLost = 1000;
}  // namespace

RigidSystem::State::State(const RigidWalls& bounds, Vec2 pull, const RigidMethod& how, ThreadPool& threads)
    : walls(bounds),
      gravity(pull),
      method(how),
      pool(threads),
      broad(bounds, threads),
      narrow(threads),
      blocks(threads),
      springs(threads) {
  constexpr double kEdge = 1e-12;  // of the domain: inside by more than a rounding
  bodies.period = {bounds.width, bounds.height};
  edge = kEdge * bodies.period;
  addWalls();
}

void RigidSystem::State::addWalls() {
  const double w = walls.width, hgt = walls.height, thick = std::max({w, hgt, 1.0});
  const Vec2 sizes[] = {
      {thick, hgt + 2 * thick}, {thick, hgt + 2 * thick}, {w + 2 * thick, thick}, {w + 2 * thick, thick}};
  const Vec2 middles[] = {{-0.5 * thick, 0.5 * hgt},
                          {w + 0.5 * thick, 0.5 * hgt},
                          {0.5 * w, -0.5 * thick},
                          {0.5 * w, hgt + 0.5 * thick}};
  for (int side = 0; side < kWalls; ++side) {
    BodyDef def;
    def.shape = std::make_shared<BodyShape>(makeSolidShape({BoxShape{sizes[side]}, {}}, 1));
    def.position = middles[side];
    def.bounce = walls.bounce;
    def.friction = walls.friction;
    bodies.def.push_back(def);
    bodies.extent.push_back(extentOf(*def.shape));
    // A wall that runs along itself never leaves: only its velocity counts.
    Motion v;
    (side < 2 ? v.y : v.x) = walls.speeds[side];
    bodies.velocity.push_back(v);
    bodies.moved.push_back({});
    bodies.inverse.push_back({});
    bodies.position.push_back(def.position);
    bodies.wound.push_back({});
    bodies.angleRad.push_back(0);
    bodies.turn.push_back({});
    bodies.there.push_back(walls.sides[side] == RigidWalls::Kind::closed);
    resume.push_back({});
    fresh.push_back(0);
    departed.push_back(0);
    targetPlace.push_back(def.position);
    targetAngle.push_back(0);
    ahead.push_back({});
  }
}

void RigidSystem::State::setInverse(int body) {
  bodies.defsChanged = true;
  const BodyDef& def = bodies.def[body];
  bodies.inverse[body] = {};
  if (def.held || def.mass <= 0) return;
  bodies.inverse[body] = {1 / def.mass, def.inertia > 0 ? 1 / def.inertia : 0};
}

namespace {
/// The integral of exp(-c t): the time in which a force without damping does as much.
double timeUnder(double c, double time) {
  const double x = c * time;
  return x < 1e-3 ? time * (1 - x / 2 * (1 - x / 3 * (1 - x / 4))) : (1 - exact::exp(-x)) / c;
}
}  // namespace

RigidSystem::State::Drive RigidSystem::State::driveOver(const BodyDef& def, double time) const {
  Drive drive;
  if (def.linearDamping > 0) drive.linear = exact::exp(-def.linearDamping * time);
  if (def.angularDamping > 0) drive.angular = exact::exp(-def.angularDamping * time);
  drive.gain = timeUnder(def.linearDamping, time) * def.gravityScale * gravity;
  return drive;
}

void RigidSystem::State::findSeenByForces() {
  if (!damped) return;
  const double h = dt / method.subSteps;
  forImpacts = bodies.inverse;
  for (int b = kWalls; b < bodies.count(); ++b) {
    if (!bodies.moves(b)) continue;
    bodies.inverse[b].mass *= timeUnder(bodies.def[b].linearDamping, h) / h;
    bodies.inverse[b].inertia *= timeUnder(bodies.def[b].angularDamping, h) / h;
  }
}

// Velocities belong to the middle of a sub-step: those that were set are taken half of one back, and where
// gravity has changed, what it did to the last half is put right.
void RigidSystem::State::startVelocities(double h) {
  firstOfStep = true;
  const bool changed = bodies.defsChanged || h != drivesStep || gravity != drivesGravity;
  drivesStep = h;
  drivesGravity = gravity;
  if (changed) damped = false;
  constexpr double kLeast = 1e-6;  // of a velocity; what is damped more has no past to come from
  drives.resize(bodies.count());
  halfDrives.resize(bodies.count());
  for (int b = kWalls; b < bodies.count(); ++b) {
    if (!bodies.there[b]) {
      drives[b] = halfDrives[b] = {};
      continue;
    }
    Motion& v = bodies.velocity[b];
    if (bodies.surface[b].isDriven) {
      const Vec2 by = targetPlace[b] - bodies.position[b];
      v = {by.x / dt, by.y / dt, (targetAngle[b] - bodies.angleRad[b]) / dt};
    }
    if (!changed && !fresh[b]) continue;
    if (!bodies.moves(b)) {
      drives[b] = halfDrives[b] = {};
      continue;
    }
    const BodyDef& def = bodies.def[b];
    damped |= def.linearDamping > 0 || def.angularDamping > 0;
    const Drive now = driveOver(def, 0.5 * h), was = halfDrives[b];
    drives[b] = driveOver(def, h);
    halfDrives[b] = now;
    if (fresh[b] & 1) {
      const double back = 1 / std::max(now.linear, kLeast);
      v.x = back * (v.x - now.gain.x);
      v.y = back * (v.y - now.gain.y);
    } else if (now.gain != was.gain) {
      v.x += was.gain.x - now.gain.x;
      v.y += was.gain.y - now.gain.y;
    }
    if (fresh[b] & 2) v.turn /= std::max(now.angular, kLeast);
  }
}

void RigidSystem::State::beginStep(double step) {
  dt = timeLeft = step;
  bodies.takeSurfaces();
  startVelocities(dt / method.subSteps);
  findSeenByForces();
  touches.clear();
  calmTouches = 0;
  broad.update(bodies, gravity, dt);
  narrow.beginStep(bodies, broad, press, gravity, dt, method.subSteps);
  const double pull = length(gravity);
  blocks.build(bodies, narrow.calm(), uncoloured, pull > 0 ? (1 / pull) * gravity : Vec2{},
               leftUndone > kUnsettled * pull * dt / method.subSteps);
  leftUndone = 0;
  spare.clear();
  for (const int k : uncoloured) {
    spare.emplace_back(narrow.calm()[k]);
    setMasses(bodies, spare.back());
  }
  if (bodies.defsChanged) takeCensus();
  bodies.defsChanged = false;
  bouncing.clear();
  for (std::size_t k = 0; mayBounce && k < narrow.calm().size(); ++k)
    if (const Contact& c = narrow.calm()[k]; c.bounce > 0 && !press.sinks(c.a, c.b))
      bouncing.push_back(static_cast<int>(k));
  springs.beginStep(bodies, dt, method.subSteps);
  joints.beginStep(bodies, dt, method.subSteps);
  start.resize(bodies.count());
  carried = Carried::nothing;
  impact.beginStep();
  flying.resize(bodies.count(), 1);
  struck.resize(bodies.count());
  way.resize(bodies.count());
}

void RigidSystem::State::takeCensus() {
  mayBounce = false;
  int moving = 0;
  typicalWidth = 0;
  for (int b = 0; b < bodies.count(); ++b) {
    mayBounce |= bodies.there[b] && bodies.surface[b].bounce > 0;
    if (!bodies.moves(b)) continue;
    ++moving;
    typicalWidth += bodies.extent[b].thinnest;
  }
  typicalWidth /= std::max(moving, 1);
}

// Of the last two sub-steps, what findAhead() asks for.
void RigidSystem::State::remember(double h, double left) {
  if (left > 2.5 * h) return;
  beforeThat.swap(before);
  before = bodies.velocity;
  if (beforeThat.size() != before.size()) beforeThat = before;
}

Lanes RigidSystem::State::drivenBy(int body, Lanes velocity) const {
  const Lanes drive = load(&drives[body].gain.x), zero{};
  const Lanes left = __builtin_shufflevector(drive, drive, 2, 2, 3, 3),
              gain = __builtin_shufflevector(drive, zero, 0, 1, 6, 7);
  return left * velocity + gain;
}

void RigidSystem::State::predict(double h) {
  if (carried != Carried::all) {  // else the last sub-step has done it
    remember(h, timeLeft);
    eachBody([&](int b) {
      double* v = &bodies.velocity[b].x;
      store(v, drivenBy(b, load(v)));
    });
  }
  narrow.refresh(bodies, broad, h, nullptr);
}

void RigidSystem::State::bounce(double h) {
  if (anyStruck) std::fill(struck.begin(), struck.end(), Motion{});
  anyStruck = false;
  if (!mayBounce) return;
  if (damped) bodies.inverse.swap(forImpacts);
  impacts(h);
  if (damped) bodies.inverse.swap(forImpacts);
  for (SolvedContact& contact : narrow.lively())
    if (std::exchange(contact.met, false)) setMasses(bodies, contact);
  if (!anyStruck) return;
  // From here on the bodies go straight ways, as if they had come from where these begin.
  for (int b = kWalls; b < bodies.count(); ++b) {
    Motion& m = bodies.moved[b];
    m.x += struck[b].x;
    m.y += struck[b].y;
    m.turn += struck[b].turn;
  }
}

void RigidSystem::State::impacts(double h) {
  const double least = kRestingSubSteps * h * length(gravity) + 1e-7;
  impact.begin(flying);
  constexpr int kRounds = 6;  // a body that is struck may meet others of which nothing was known yet
  for (int round = 0; round < kRounds; ++round) {
    bouncers.clear();
    for (const int k : bouncing)
      if (!narrow.isDropped(k) && !isSqueezed(narrow.calm()[k])) bouncers.push_back(&narrow.calm()[k]);
    for (Contact& contact : narrow.lively())
      if (contact.bounce > 0 && !isSqueezed(contact)) bouncers.push_back(&contact);
    if (bouncers.empty()) return;
    // Who is struck must not have flown on through what it does not bounce off.
    for (Contact& contact : narrow.lively())
      if (contact.bounce <= 0 && meetsFast(contact, h)) bouncers.push_back(&contact);
    impact.run(bodies, bouncers, h, gravity, least, struck, round > 0);
    if (impact.count() == 0) return;
    anyStruck = true;
    giveBackSpare();
    if (narrow.stir(bodies, &struck, broad, gravity, blocks, timeLeft) != NarrowPhase::Stir::none)
      carried = Carried::nothing;
    narrow.refreshAfterImpacts(bodies, broad, h, struck, impact.moments());
  }
}

// What is pressed into each other and pushed apart already does not bounce: it would be struck over and over.
bool RigidSystem::State::isSqueezed(const Contact& contact) const {
  if (press.sinks(contact.a, contact.b)) return true;
  const double deep = -kSqueezed * thinner(bodies, contact.a, contact.b);
  for (int k = 0; k < contact.count; ++k)
    if (contact.points[k].impulseN > 0 &&
        contact.points[k].gap + gapMoved(bodies, contact, contact.points[k]) < deep)
      return true;
  return false;
}

bool RigidSystem::State::meetsFast(const Contact& contact, double h) const {
  const double thin = thinner(bodies, contact.a, contact.b);
  for (int k = 0; k < contact.count; ++k)
    if (-partingSpeed(bodies, contact, contact.points[k]) * h > kSwept * thin) return true;
  return false;
}

// What can be made of the next sub-step's velocities as the bodies come by anyway: the calm contacts' normals
// and arms are the same all through the step, and so is the sum of what their impulses add.
void RigidSystem::State::moveOn(double h) {
  const bool mayPass = narrow.mayPass(bodies, h);
  if (mayPass) {
    eachBody([&](int b) { store(&way[b].x, h * load(&bodies.velocity[b].x)); });
    narrow.stopPassing(bodies, broad, h, anyStruck ? &impact.moments() : nullptr, way);
  }
  const std::vector<Motion>& by = mayPass ? way : bodies.velocity;
  const double times = mayPass ? 1 : h;
  const auto each = [&](auto&& carry) {
    eachBody([&](int b) {
      const Lanes v = load(&bodies.velocity[b].x), added = v - load(&start[b].x);
      store(&bodies.moved[b].x, load(&bodies.moved[b].x) + times * load(&by[b].x));
      if (!isInside(b)) keepInside(b);
      carry(b, added);
    });
  };
  if (carried == Carried::all) {
    remember(h, timeLeft - h);
    std::copy_n(bodies.velocity.begin(), kWalls, start.begin());
    each([&](int b, Lanes added) {
      const Lanes v = drivenBy(b, load(&bodies.velocity[b].x));
      store(&bodies.velocity[b].x, v);
      store(&start[b].x, v + added);
    });
  } else if (carried == Carried::share) {
    std::fill_n(start.begin(), kWalls, Motion{});
    each([&](int b, Lanes added) { store(&start[b].x, added); });
  } else {
    each([](int, Lanes) {});
  }
}

void RigidSystem::State::move(double h) {
  const bool isLast = timeLeft < 1.5 * h;
  // After contacts were dropped or found anew, or have yielded, not all that the velocities gained is on
  // record.
  const bool isKnown = springs.empty() && joints.empty() && !stirred && !isLast;
  carried = !isKnown ? Carried::nothing : mayBounce ? Carried::share : Carried::all;
  moveOn(h);
  if (isKnown) takeOutLone();
  separateAll(h);
  for (const Contact& contact : narrow.lively()) collectTouch(contact);
  narrow.advance();
  timeLeft -= h;
}

// Those of the calm pairs are in order already, but for the walls'.
void RigidSystem::State::sortTouches() {
  const auto middle =
      touches.begin() + std::exchange(calmTouches, static_cast<std::ptrdiff_t>(touches.size()));
  if (middle == touches.end()) return;
  auto isBefore = [](const Touch& p, const Touch& q) { return p.a < q.a || (p.a == q.a && p.b < q.b); };
  const auto ofBodies =
      std::partition_point(middle, touches.end(), [](const Touch& touch) { return touch.a < 0; });
  std::stable_sort(touches.begin(), middle, isBefore);
  std::stable_sort(middle, ofBodies, isBefore);
  std::inplace_merge(touches.begin(), middle, touches.end(), isBefore);
}

bool RigidSystem::State::isInside(int body) const {
  const Vec2 at = bodies.positionNow(body);
  return at.x > edge.x && at.x < walls.width - edge.x && at.y > edge.y && at.y < walls.height - edge.y;
}

// Whatever presses, no centre of mass goes through a closed side of the domain.
void RigidSystem::State::keepInside(int body) {
  if (!bodies.moves(body)) return;
  const auto keep = [&](double at, double size, double margin, int low, double& moved, double& speed) {
    const auto isShut = [&](int side) { return walls.sides[side] == RigidWalls::Kind::closed; };
    if (isShut(low) && at < margin) {
      moved += margin - at;
      speed = std::max(speed, 0.0);
    } else if (isShut(low + 1) && at > size - margin) {
      moved += size - margin - at;
      speed = std::min(speed, 0.0);
    }
  };
  const Vec2 at = bodies.positionNow(body);
  keep(at.x, walls.width, edge.x, 0, bodies.moved[body].x, bodies.velocity[body].x);
  keep(at.y, walls.height, edge.y, 2, bodies.moved[body].y, bodies.velocity[body].y);
}

void RigidSystem::State::collectTouch(const Contact& contact) {
  if (contact.total <= 0) return;
  Touch touch;
  touch.a = contact.a < kWalls ? -1 : contact.a;
  touch.b = contact.b < kWalls ? -1 : contact.b;
  Vec2 point{};
  for (int k = 0; k < contact.count; ++k)
    point = point + (1.0 / contact.count) * (bodies.positionNow(contact.a) + contact.points[k].armA);
  touch.point = point;
  touch.normal = contact.normal;
  touch.impulse = contact.total;
  touch.approach = contact.approach;
  touches.push_back(touch);
}

// Half a sub-step of what the body does by itself, and half of what the last one gave it beyond that, as long
// as it is a force: as small as what gravity does, or much the same as in the sub-step before. A blow is
// over.
void RigidSystem::State::findAhead(int body, double h) {
  ahead[body] = {};
  if (!bodies.moves(body)) return;
  const Motion &v = bodies.velocity[body], &was = before[body], &earlier = beforeThat[body];
  const Drive &whole = drives[body], &half = halfDrives[body];
  const Motion own{(half.linear - 1) * v.x + half.gain.x, (half.linear - 1) * v.y + half.gain.y,
                   (half.angular - 1) * v.turn};
  if (anyStruck && impact.wasStruck(body)) {
    ahead[body] = own;
    return;
  }
  auto given = [&](const Motion& from, const Motion& to) -> Motion {
    return {to.x - (whole.linear * from.x + whole.gain.x), to.y - (whole.linear * from.y + whole.gain.y),
            to.turn - whole.angular * from.turn};
  };
  const Motion now = given(was, v), last = method.subSteps > 1 ? given(earlier, was) : now;
  const double reach = bodies.extent[body].reach, small = kForce * h * length(gravity);
  auto size = [&](const Motion& m) { return length(m.linear()) + reach * std::abs(m.turn); };
  const Motion change{now.x - last.x, now.y - last.y, now.turn - last.turn};
  if (size(now) > small && size(change) > 0.5 * size(last)) return;
  ahead[body] = {own.x + 0.5 * now.x, own.y + 0.5 * now.y, own.turn + 0.5 * now.turn};
}

void RigidSystem::State::endStep(double step) {
  for (int b = kWalls; b < bodies.count(); ++b)
    if (!isInside(b)) keepInside(b);
  giveBackSpare();
  contactTotals = {};
  const bool pressing = press.begin(bodies);
  auto count = [&](const Contact& contact, bool isUpToDate) {
    double overlap = 0;
    for (int k = 0; k < contact.count; ++k) {
      const ContactPoint& p = contact.points[k];
      const double gap = p.gap + (isUpToDate ? 0 : gapMoved(bodies, contact, p));
      contactTotals.contacts += p.impulseN > 0 || gap <= 0;
      overlap = std::max(overlap, -gap);
    }
    contactTotals.overlap = std::max(contactTotals.overlap, overlap);
    if (pressing && contact.count > 0) press.add(bodies, contact, overlap);
  };
  for (const SolvedContact& contact : narrow.lively()) count(contact, false);
  turned.resize(bodies.count());
  eachBody([&](int b) { turned[b] = turnedBy({}, bodies.moved[b].turn); });
  calmTouches = static_cast<std::ptrdiff_t>(touches.size());
  constexpr int kContacts = 256;
  const int calm = static_cast<int>(narrow.calm().size());
  pool.blocks(0, calm, kContacts, [&](int k, int end) {
    for (; k < end; ++k) blocks.readBack(k, narrow.calm()[k]);
  });
  for (const Contact& contact : narrow.calm()) collectTouch(contact);
  pool.blocks(0, calm, kContacts, [&](int k, int end) {
    for (; k < end; ++k) bringUpToDate(bodies, turned, narrow.calm()[k]);  // it may be used again
  });
  for (int k = 0; k < calm; ++k)
    if (!narrow.isDropped(k)) count(narrow.calm()[k], true);
  if (pressing) press.end(bodies);
  narrow.endStep(broad);
  springs.endStep(bodies);
  joints.endStep(bodies);
  if (damped) bodies.inverse.swap(forImpacts);

  eachBody([&](int b) {
    if (!bodies.there[b]) return;
    findAhead(b, dt / method.subSteps);
    const Motion& m = bodies.moved[b];
    if (bodies.surface[b].isDriven) {
      bodies.position[b] = targetPlace[b];
      bodies.angleRad[b] = targetAngle[b];
    } else {
      bodies.position[b] = bodies.position[b] + m.linear();
      bodies.angleRad[b] += m.turn;
    }
    if (m.turn != 0) bodies.turn[b] = turnBy(bodies.angleRad[b]);
    bodies.moved[b] = {};
  });
  for (int b = kWalls; b < bodies.count(); ++b) {
    if (!bodies.there[b]) continue;
    const Motion& v = bodies.velocity[b];
    if (!std::isfinite(bodies.position[b].x + bodies.position[b].y + bodies.angleRad[b] + v.x + v.y + v.turn))
      throw SimulationError("the motion of body " + std::to_string(b) + " is not a finite number");
    wrap(b);
    if (!departed[b] && leaves(b)) {
      departed[b] = 1;
      gone.push_back(b);
    }
  }
  (void)step;
}

void RigidSystem::State::wrap(int body) {
  if (bodies.surface[body].isDriven) return;
  Vec2 &x = bodies.position[body], off;
  if (walls.sides[0] == RigidWalls::Kind::periodic) off.x = walls.width * std::floor(x.x / walls.width);
  if (walls.sides[2] == RigidWalls::Kind::periodic) off.y = walls.height * std::floor(x.y / walls.height);
  x = x - off;
  bodies.wound[body] = bodies.wound[body] + off;
}

// Beyond an open side, and nothing there is brings it back: neither its way, nor gravity, nor what it is tied
// to, unless that has let it go by a whole domain.
bool RigidSystem::State::leaves(int body) {
  const Vec2 x = bodies.position[body], size{walls.width, walls.height};
  const double r = bodies.extent[body].reach;
  const Motion& v = bodies.velocity[body];
  const Vec2 pull = bodies.moves(body) ? bodies.surface[body].gravityScale * gravity : Vec2{};
  const auto goes = [&](int side, double beyond, double speed, double outward, double across) {
    if (walls.sides[side] != RigidWalls::Kind::open || beyond <= r) return false;
    if (beyond > kLost * across) return true;
    if (speed < 0 || outward < 0) return false;
    return beyond > across || !(springs.ties(body) || joints.ties(body));
  };
  return goes(0, -x.x, -v.x, -pull.x, size.x) || goes(1, x.x - size.x, v.x, pull.x, size.x) ||
         goes(2, -x.y, -v.y, -pull.y, size.y) || goes(3, x.y - size.y, v.y, pull.y, size.y);
}

}  // namespace smokebox

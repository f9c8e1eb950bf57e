#include "rigid/contact_sweeps.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace smokebox {

void setMasses(const Bodies& bodies, SolvedContact& contact) {
  const InverseMass a = bodies.inverse[contact.a], b = bodies.inverse[contact.b];
  const Vec2 tangent = perpendicular(contact.normal);
  for (int k = 0; k < contact.count; ++k) {
    const ContactPoint& p = contact.points[k];
    auto massAlong = [&](Vec2 d) {
      const double ta = cross(p.armA, d), tb = cross(p.armB, d);
      const double inverse = a.mass + b.mass + a.inertia * ta * ta + b.inertia * tb * tb;
      return inverse > 0 ? 1 / inverse : 0;
    };
    contact.massN[k] = massAlong(contact.normal);
    contact.massT[k] = massAlong(tangent);
    contact.response[2 * k] = contact.massN[k] > 0 ? 1 / contact.massN[k] : 0;
  }
  contact.response[3] = 0;
  if (contact.count != 2) return;
  const ContactPoint &p = contact.points[0], &q = contact.points[1];
  const Vec2 n = contact.normal;
  contact.response[1] = a.mass + b.mass + a.inertia * cross(p.armA, n) * cross(q.armA, n) +
                        b.inertia * cross(p.armB, n) * cross(q.armB, n);
  constexpr double kApart = 1e-6;
  const double k0 = contact.response[0], k1 = contact.response[1], k2 = contact.response[2];
  const double det = k0 * k2 - k1 * k1;
  if (k0 > 0 && k2 > 0 && det > kApart * k0 * k2) contact.response[3] = 1 / det;
}

double partingSpeed(const Bodies& bodies, const Contact& contact, const ContactPoint& point) {
  return dot(contact.normal,
             bodies.velocityAt(contact.b, point.armB) - bodies.velocityAt(contact.a, point.armA));
}

double gapMoved(const Bodies& bodies, const Contact& contact, const ContactPoint& point) {
  const Motion &da = bodies.moved[contact.a], &db = bodies.moved[contact.b];
  return dot(contact.normal, db.linear() - da.linear()) + db.turn * cross(point.armB, contact.normal) -
         da.turn * cross(point.armA, contact.normal);
}

void pushApart(Bodies& bodies, const Contact& contact, const ContactPoint& point, double normal,
               double tangential) {
  const Vec2 impulse = normal * contact.normal + tangential * perpendicular(contact.normal);
  bodies.push(contact.a, point.armA, -impulse);
  bodies.push(contact.b, point.armB, impulse);
}

void warmStart(Bodies& bodies, const std::vector<SolvedContact>& contacts) {
  for (const SolvedContact& contact : contacts)
    for (int k = 0; k < contact.count; ++k)
      pushApart(bodies, contact, contact.points[k], contact.points[k].impulseN, contact.points[k].impulseT);
}

void solveBoth(const double k[4], const double speed[2], double impulse[2]) {
  impulse[0] = k[3] * (k[1] * speed[1] - k[2] * speed[0]);
  impulse[1] = k[3] * (k[1] * speed[0] - k[0] * speed[1]);
  if (impulse[0] >= 0 && impulse[1] >= 0) return;
  impulse[0] = std::max(-speed[0] / k[0], 0.0);
  impulse[1] = 0;
  if (k[1] * impulse[0] + speed[1] >= 0) return;
  impulse[0] = 0;
  impulse[1] = std::max(-speed[1] / k[2], 0.0);
}

namespace {

/// Two points at one place are solved one after the other.
bool areTwo(const SolvedContact& contact) { return contact.count == 2 && contact.response[3] > 0; }

}  // namespace

void prepare(const Bodies& bodies, std::vector<SolvedContact>& contacts, double h) {
  const double perSecond = 1 / h;
  for (SolvedContact& contact : contacts)
    for (int k = 0; k < contact.count; ++k) {
      const ContactPoint& p = contact.points[k];
      contact.allowed[k] = std::max(p.gap + gapMoved(bodies, contact, p), 0.0) * perSecond;
    }
}

double solve(Bodies& bodies, SolvedContact& contact) {
  double largest = 0;
  const InverseMass ma = bodies.inverse[contact.a], mb = bodies.inverse[contact.b];
  Motion &a = bodies.velocity[contact.a], &b = bodies.velocity[contact.b];
  // What counts is b's velocity less a's; each of the two is written once.
  double vx = b.x - a.x, vy = b.y - a.y, turnA = a.turn, turnB = b.turn;
  const Vec2 n = contact.normal, t = perpendicular(n);
  const double inverse = ma.mass + mb.mass;
  auto speed = [&](Vec2 along, const ContactPoint& p) {
    return (along.x * vx + along.y * vy) + (turnB * cross(p.armB, along) - turnA * cross(p.armA, along));
  };
  Vec2 given{};
  auto push = [&](Vec2 along, double impulse) {
    vx += inverse * along.x * impulse;
    vy += inverse * along.y * impulse;
    given = given + impulse * along;
  };
  auto turn = [&](Vec2 along, const ContactPoint& p, double impulse) {
    turnA -= ma.inertia * cross(p.armA, along) * impulse;
    turnB += mb.inertia * cross(p.armB, along) * impulse;
  };
  contact.spare = contact.change = 0;
  double parts = std::numeric_limits<double>::infinity();
  auto isIdle = [&](int k) {
    const ContactPoint& p = contact.points[k];
    if (p.impulseN != 0 || p.impulseT != 0) return false;
    parts = std::min(parts, speed(n, p) + contact.allowed[k]);
    return parts >= 0;
  };
  if (isIdle(0) && (contact.count < 2 || isIdle(1))) {
    contact.spare = parts;
    return 0;
  }
  auto change = [&](int k, double total) {
    ContactPoint& p = contact.points[k];
    const double by = total - p.impulseN;
    p.impulseN = total;
    turn(n, p, by);
    largest = std::max(largest, std::abs(by) * contact.response[2 * k]);
    return by;
  };
  if (areTwo(contact)) {
    const ContactPoint &p = contact.points[0], &q = contact.points[1];
    const double* k = contact.response;
    const double free[2] = {speed(n, p) + contact.allowed[0] - k[0] * p.impulseN - k[1] * q.impulseN,
                            speed(n, q) + contact.allowed[1] - k[1] * p.impulseN - k[2] * q.impulseN};
    double total[2];
    solveBoth(k, free, total);
    push(n, change(0, total[0]) + change(1, total[1]));
  } else {
    for (int k = 0; k < contact.count; ++k) {
      const ContactPoint& p = contact.points[k];
      push(n, change(k, std::max(p.impulseN - contact.massN[k] * (speed(n, p) + contact.allowed[k]), 0.0)));
    }
  }
  for (int k = 0; k < contact.count; ++k) {
    ContactPoint& p = contact.points[k];
    const double most = contact.friction * p.impulseN;
    const double tangential = std::clamp(p.impulseT - contact.massT[k] * speed(t, p), -most, most);
    const double by = tangential - p.impulseT;
    push(t, by);
    turn(t, p, by);
    p.impulseT = tangential;
  }
  a.x -= ma.mass * given.x;
  a.y -= ma.mass * given.y;
  a.turn = turnA;
  b.x += mb.mass * given.x;
  b.y += mb.mass * given.y;
  b.turn = turnB;
  return contact.change = largest;
}

double solve(Bodies& bodies, std::vector<SolvedContact>& contacts, double enough) {
  double largest = 0;
  for (SolvedContact& contact : contacts)
    if (contact.spare <= enough) largest = std::max(largest, solve(bodies, contact));
  return largest;
}

double separate(Bodies& bodies, const SolvedContact& contact, double share, double most) {
  double deepest = 0;
  auto lacking = [&](const ContactPoint& p) {
    const double gap = p.gap + gapMoved(bodies, contact, p);
    deepest = std::max(deepest, -gap);
    return gap < 0 ? std::max(share * gap, -most) : gap;
  };
  auto push = [&](const ContactPoint& p, double impulse) {
    auto shift = [&](int body, Vec2 arm, double sign) {
      Motion& d = bodies.moved[body];
      const InverseMass& m = bodies.inverse[body];
      d.x += sign * m.mass * contact.normal.x * impulse;
      d.y += sign * m.mass * contact.normal.y * impulse;
      d.turn += sign * m.inertia * cross(arm, contact.normal) * impulse;
    };
    shift(contact.a, p.armA, -1);
    shift(contact.b, p.armB, 1);
  };
  double lacks[2] = {0, 0};
  for (int k = 0; k < contact.count; ++k) lacks[k] = lacking(contact.points[k]);
  if (lacks[0] >= 0 && lacks[1] >= 0) return 0;
  if (areTwo(contact)) {
    double impulse[2];
    solveBoth(contact.response, lacks, impulse);
    for (int k = 0; k < 2; ++k)
      if (impulse[k] > 0) push(contact.points[k], impulse[k]);
    return deepest;
  }
  for (int k = 0; k < contact.count; ++k) {
    const ContactPoint& p = contact.points[k];
    const double lack = lacking(p);
    if (lack < 0) push(p, -contact.massN[k] * lack);
  }
  return deepest;
}

}  // namespace smokebox

#include "rigid/contact_sweeps.h"

#include <algorithm>
#include <cmath>

namespace smokebox {

void setMasses(const Bodies& bodies, Contact& contact) {
  const InverseMass a = bodies.inverse[contact.a], b = bodies.inverse[contact.b];
  const Vec2 tangent = perpendicular(contact.normal);
  for (int k = 0; k < contact.count; ++k) {
    ContactPoint& p = contact.points[k];
    auto massAlong = [&](Vec2 d) {
      const double ta = cross(p.armA, d), tb = cross(p.armB, d);
      const double inverse = a.mass + b.mass + a.inertia * ta * ta + b.inertia * tb * tb;
      return inverse > 0 ? 1 / inverse : 0;
    };
    p.massN = massAlong(contact.normal);
    p.massT = massAlong(tangent);
  }
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

void warmStart(Bodies& bodies, const std::vector<Contact>& contacts) {
  for (const Contact& contact : contacts)
    for (int k = 0; k < contact.count; ++k)
      pushApart(bodies, contact, contact.points[k], contact.points[k].impulseN, contact.points[k].impulseT);
}

void solveBoth(const double k[3], const double speed[2], double impulse[2]) {
  const double det = k[0] * k[2] - k[1] * k[1];
  impulse[0] = (k[1] * speed[1] - k[2] * speed[0]) / det;
  impulse[1] = (k[1] * speed[0] - k[0] * speed[1]) / det;
  if (impulse[0] >= 0 && impulse[1] >= 0) return;
  impulse[0] = std::max(-speed[0] / k[0], 0.0);
  impulse[1] = 0;
  if (k[1] * impulse[0] + speed[1] >= 0) return;
  impulse[0] = 0;
  impulse[1] = std::max(-speed[1] / k[2], 0.0);
}

namespace {

/// What impulses of 1 at a contact's points make of their parting speeds. False: the two are at one place, or
/// there is only one.
bool responses(const Bodies& bodies, const Contact& contact, double k[3]) {
  const ContactPoint &p = contact.points[0], &q = contact.points[1];
  if (contact.count != 2 || !(p.massN > 0) || !(q.massN > 0)) return false;
  const InverseMass a = bodies.inverse[contact.a], b = bodies.inverse[contact.b];
  const Vec2 n = contact.normal;
  k[0] = 1 / p.massN;
  k[1] = a.mass + b.mass + a.inertia * cross(p.armA, n) * cross(q.armA, n) +
         b.inertia * cross(p.armB, n) * cross(q.armB, n);
  k[2] = 1 / q.massN;
  return k[0] * k[2] - k[1] * k[1] > 1e-6 * k[0] * k[2];
}

}  // namespace

double solve(Bodies& bodies, std::vector<Contact>& contacts, double h) {
  double largest = 0;
  for (Contact& contact : contacts) {
    double lacks[2] = {0, 0};
    for (int k = 0; k < contact.count; ++k) {
      const ContactPoint& p = contact.points[k];
      const double gap = p.gap + gapMoved(bodies, contact, p);
      lacks[k] = partingSpeed(bodies, contact, p) + std::max(gap, 0.0) / h;
    }
    double total[2] = {0, 0}, response[3];
    const bool both = responses(bodies, contact, response);
    if (both) {
      const double before[2] = {contact.points[0].impulseN, contact.points[1].impulseN};
      const double free[2] = {lacks[0] - response[0] * before[0] - response[1] * before[1],
                              lacks[1] - response[1] * before[0] - response[2] * before[1]};
      solveBoth(response, free, total);
    }
    for (int k = 0; k < contact.count; ++k) {
      ContactPoint& p = contact.points[k];
      if (!both) {
        if (k == 1)
          lacks[1] =
              partingSpeed(bodies, contact, p) + std::max(p.gap + gapMoved(bodies, contact, p), 0.0) / h;
        total[k] = std::max(p.impulseN - p.massN * lacks[k], 0.0);
      }
      const double change = total[k] - p.impulseN;
      p.impulseN = total[k];
      pushApart(bodies, contact, p, change, 0);
      if (p.massN > 0) largest = std::max(largest, std::abs(change) / p.massN);
    }
    for (int k = 0; k < contact.count; ++k) {
      ContactPoint& p = contact.points[k];
      const Vec2 slip = bodies.velocityAt(contact.b, p.armB) - bodies.velocityAt(contact.a, p.armA);
      const double vt = dot(perpendicular(contact.normal), slip), most = contact.friction * p.impulseN;
      const double tangential = std::clamp(p.impulseT - p.massT * vt, -most, most);
      pushApart(bodies, contact, p, 0, tangential - p.impulseT);
      p.impulseT = tangential;
    }
  }
  return largest;
}

void separate(Bodies& bodies, std::vector<Contact>& contacts, double share, double most) {
  for (Contact& contact : contacts) {
    for (int k = 0; k < contact.count; ++k) contact.total += contact.points[k].impulseN;
    auto lacking = [&](const ContactPoint& p) {
      const double gap = p.gap + gapMoved(bodies, contact, p);
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
    double lacks[2] = {0, 0}, response[3];
    for (int k = 0; k < contact.count; ++k) lacks[k] = lacking(contact.points[k]);
    if (lacks[0] >= 0 && lacks[1] >= 0) continue;
    if (responses(bodies, contact, response)) {
      double impulse[2];
      solveBoth(response, lacks, impulse);
      for (int k = 0; k < 2; ++k)
        if (impulse[k] > 0) push(contact.points[k], impulse[k]);
      continue;
    }
    for (int k = 0; k < contact.count; ++k) {
      const ContactPoint& p = contact.points[k];
      const double lack = lacking(p);
      if (lack < 0) push(p, -p.massN * lack);
    }
  }
}

}  // namespace smokebox

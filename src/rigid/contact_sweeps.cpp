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

double solve(Bodies& bodies, std::vector<Contact>& contacts, double h) {
  double largest = 0;
  for (Contact& contact : contacts)
    for (int k = 0; k < contact.count; ++k) {
      ContactPoint& p = contact.points[k];
      const double gap = p.gap + gapMoved(bodies, contact, p);
      const double vn = partingSpeed(bodies, contact, p);
      const double total = std::max(p.impulseN - p.massN * (vn + std::max(gap, 0.0) / h), 0.0);
      const double change = total - p.impulseN;
      p.impulseN = total;
      pushApart(bodies, contact, p, change, 0);
      if (p.massN > 0) largest = std::max(largest, std::abs(change) / p.massN);

      const Vec2 slip = bodies.velocityAt(contact.b, p.armB) - bodies.velocityAt(contact.a, p.armA);
      const double vt = dot(perpendicular(contact.normal), slip), most = contact.friction * p.impulseN;
      const double tangential = std::clamp(p.impulseT - p.massT * vt, -most, most);
      pushApart(bodies, contact, p, 0, tangential - p.impulseT);
      p.impulseT = tangential;
    }
  return largest;
}

void separate(Bodies& bodies, std::vector<Contact>& contacts, double share, double most) {
  for (Contact& contact : contacts)
    for (int k = 0; k < contact.count; ++k) {
      ContactPoint& p = contact.points[k];
      contact.total += p.impulseN;
      const double gap = p.gap + gapMoved(bodies, contact, p);
      if (gap >= 0) continue;
      const double impulse = p.massN * std::min(-share * gap, most);
      auto shift = [&](int body, Vec2 arm, double sign) {
        Motion& d = bodies.moved[body];
        const InverseMass& m = bodies.inverse[body];
        d.x += sign * m.mass * contact.normal.x * impulse;
        d.y += sign * m.mass * contact.normal.y * impulse;
        d.turn += sign * m.inertia * cross(arm, contact.normal) * impulse;
      };
      shift(contact.a, p.armA, -1);
      shift(contact.b, p.armB, 1);
    }
}

}  // namespace smokebox

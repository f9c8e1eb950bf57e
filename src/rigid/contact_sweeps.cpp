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

namespace {

/// Both normal impulses of a contact at once: the 2 x 2 linear complementarity problem by its four cases
/// (Murty; as in Catto's block solver). `speed`: what each point's parting speed lacks without any impulse.
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
    double total[2] = {0, 0};
    const ContactPoint &p0 = contact.points[0], &p1 = contact.points[1];
    bool both = contact.count == 2 && p0.massN > 0 && p1.massN > 0;
    if (both) {
      const InverseMass ma = bodies.inverse[contact.a], mb = bodies.inverse[contact.b];
      const Vec2 n = contact.normal;
      const double k[3] = {1 / p0.massN,
                           ma.mass + mb.mass + ma.inertia * cross(p0.armA, n) * cross(p1.armA, n) +
                               mb.inertia * cross(p0.armB, n) * cross(p1.armB, n),
                           1 / p1.massN};
      both = k[0] * k[2] - k[1] * k[1] > 1e-6 * k[0] * k[2];  // else two points at one place
      if (both) {
        const double free[2] = {lacks[0] - k[0] * p0.impulseN - k[1] * p1.impulseN,
                                lacks[1] - k[1] * p0.impulseN - k[2] * p1.impulseN};
        solveBoth(k, free, total);
      }
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

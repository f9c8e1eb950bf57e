#include "rigid/pair_contacts.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "rigid/collide.h"
#include "rigid/contact_sweeps.h"
#include "rigid/distance.h"
#include "rigid/passing.h"

namespace smokebox {

namespace {
// Pieces that are nearer than this share of the thinner one's width touch, whatever their speed says: others
// may press on them within the sub-step.
constexpr double kTouching = 0.01;
// What would be struck by less than this share of the thinner one's width across the way slides over it, if
// it turns by less than that within so many sub-steps: the seam of two solids that lie flush is no step.
constexpr double kFlush = 1e-3;
constexpr double kFlushSubSteps = 16;
// Sine of the angle between normals that are one; of that between a face and a way along it, which may have a
// sub-step's fall in it.
constexpr double kAlong = 1e-3, kAlongFalling = 0.02;

/// Distance of the point from the box around a body's pieces.
double distanceFrom(const Extent& box, const Frame& frame, Vec2 point) {
  const Vec2 p = toLocal(frame, point) - box.centre;
  const Vec2 out{std::max(std::abs(p.x) - box.half.x, 0.0), std::max(std::abs(p.y) - box.half.y, 0.0)};
  return length(out);
}
}  // namespace

double clearance(const Bodies& bodies, const PairKey& key, Vec2 shift, double enough) {
  const Extent &a = bodies.extent[key.a], &b = bodies.extent[key.b];
  const Vec2 pa = bodies.positionNow(key.a), pb = bodies.positionNow(key.b) + shift;
  const double circles = length(pb - pa) - a.reach - b.reach;
  if (circles > enough) return circles;
  const double boxA = a.radius > 0 ? circles : distanceFrom(a, bodies.frameNow(key.a), pb) - b.reach;
  if (boxA > enough || b.radius > 0) return std::max(circles, boxA);
  Frame fb = bodies.frameNow(key.b);
  fb.position = pb;
  return std::max({circles, boxA, distanceFrom(b, fb, pa) - a.reach});
}

void setSurfaces(const Bodies& bodies, Contact& contact) {
  const Surface &a = bodies.surface[contact.a], &b = bodies.surface[contact.b];
  contact.friction = std::sqrt(a.friction * b.friction);
  contact.bounce = std::max(a.bounce, b.bounce);
}

void bringUpToDate(const Bodies& bodies, const std::vector<Turn>& turned, Contact& contact) {
  for (int k = 0; k < contact.count; ++k)
    contact.points[k].gap += gapMoved(bodies, contact, contact.points[k]);
  if (contact.face == 0) return;
  const bool edgeOfA = contact.face == 1;
  contact.normal = rotate(turned[edgeOfA ? contact.a : contact.b], contact.normal);
  const Turn corners = turned[edgeOfA ? contact.b : contact.a];
  const Vec2 apart = bodies.positionNow(contact.b) + bodies.shiftOf(contact) - bodies.positionNow(contact.a);
  for (int k = 0; k < contact.count; ++k) {
    ContactPoint& p = contact.points[k];
    if (edgeOfA) {
      p.armB = rotate(corners, p.armB);
      p.armA = p.armB + apart;
    } else {
      p.armA = rotate(corners, p.armA);
      p.armB = p.armA - apart;
    }
  }
}

void PairContacts::prefetch(const Bodies& bodies, int body, bool soon) {
  const ConvexPiece* piece = bodies.extent[body].only;
  if (!piece) return;
  auto lines = [](const void* from, std::size_t bytes) {
    constexpr std::size_t kLine = 64;
    for (std::size_t at = 0; at < bytes; at += kLine) __builtin_prefetch(static_cast<const char*>(from) + at);
  };
  if (!soon) {
    lines(piece, sizeof *piece);
  } else if (piece->fours.size() <= 2) {
    lines(piece->fours.data(), piece->fours.size() * sizeof piece->fours[0]);
    lines(piece->points.data(), piece->points.size() * sizeof piece->points[0]);
    lines(piece->normals.data(), piece->normals.size() * sizeof piece->normals[0]);
  }
}

namespace {
double smallestGap(const Manifold& manifold) {
  return std::min(manifold.points[0].gap, manifold.points[manifold.count - 1].gap);
}
}  // namespace

namespace {
/// How far a piece reaches along a direction: least and most.
std::array<double, 2> spanOf(const ConvexPiece& piece, const Frame& frame, Vec2 along) {
  std::array<double, 2> span{1e300, -1e300};
  for (const Vec2 p : piece.points) {
    const double at = dot(toWorld(frame, p), along);
    span = {std::min(span[0], at), std::max(span[1], at)};
  }
  return {span[0] - piece.radius, span[1] + piece.radius};
}

/// Does b, at this velocity against a, only graze it with what comes first along its way?
bool grazes(const ConvexPiece& pa, const Frame& fa, const ConvexPiece& pb, const Frame& fb, Vec2 velocity,
            Vec2 normal, double flush) {
  const double speed = length(velocity);
  if (!(speed > 0)) return false;
  const Vec2 way = (1 / speed) * velocity;
  Vec2 across = perpendicular(way);
  double least = kAlongFalling;
  const auto follow = [&](const ConvexPiece& piece, const Frame& frame) {
    for (const Vec2 own : piece.normals) {
      const Vec2 out = rotate(frame.turn, own);
      const double off = std::abs(dot(out, way));
      if (off >= least) continue;
      least = off;
      across = out;
    }
  };
  follow(pa, fa);
  follow(pb, fb);
  if (std::abs(cross(normal, across)) <= kAlong) return false;  // it lies on that
  const auto a = spanOf(pa, fa, across), b = spanOf(pb, fb, across);
  return std::min(a[1] - b[0], b[1] - a[0]) <= flush;
}
}  // namespace

double PairContacts::find(const Bodies& bodies, const PairKey& key, Vec2 shift, double margin, double h,
                          bool swept, std::vector<Contact>& found, const Later& later) {
  auto ahead = [&](int body, const Motion& struck) -> Motion {
    const Motion& v = bodies.velocity[body];
    return {struck.x + later.time * v.x, struck.y + later.time * v.y, struck.turn + later.time * v.turn};
  };
  const Motion aheadA = ahead(key.a, later.struckA), aheadB = ahead(key.b, later.struckB);
  Frame fa = bodies.frameNow(key.a), fb = bodies.frameNow(key.b);
  if (later.time > 0) {
    fa = {fa.position + aheadA.linear(), turnedBy(fa.turn, aheadA.turn)};
    fb = {fb.position + aheadB.linear(), turnedBy(fb.turn, aheadB.turn)};
  }
  fb.position = fb.position + shift;
  const double rest = h - later.time, thin = thinner(bodies, key.a, key.b);
  double clear = 1e300;
  Manifold manifold;
  const Motion &motionA = bodies.velocity[key.a], &motionB = bodies.velocity[key.b];
  const Vec2 velocity = motionB.linear() - motionA.linear();
  const double turning = std::abs(motionA.turn) * bodies.extent[key.a].turningReach() +
                         std::abs(motionB.turn) * bodies.extent[key.b].turningReach();
  const bool mayGraze = bodies.moves(key.a) != bodies.moves(key.b) && length(velocity) * h > 1e-6 * thin &&
                        turning * kFlushSubSteps * h <= kFlush * thin;
  auto meet = [&](const ConvexPiece& pa, const ConvexPiece& pb, PiecePair pieces) {
    const Vec2 apart = toWorld(fb, pb.centre) - toWorld(fa, pa.centre);
    const double near = pa.reach + pb.reach + margin;
    if (dot(apart, apart) > near * near) {
      clear = std::min(clear, length(apart) - pa.reach - pb.reach);
      return;
    }
    double share = 0;
    bool passes = false;  // they do not meet, if nothing else strikes them
    Frame ta = fa, tb = fb;
    if (swept) {
      // All that may come to touch within the sub-step counts: what others do to the two changes their ways.
      const bool isNear = collide(pa, fa, pb, fb, margin, manifold);
      if (!isNear || smallestGap(manifold) > kTouching * thin) {
        const Motion &va = bodies.velocity[key.a], &vb = bodies.velocity[key.b];
        const Sweep sa{fa, rest * va.linear(), rest * va.turn}, sb{fb, rest * vb.linear(), rest * vb.turn};
        const auto hit = timeOfImpact(pa, sa, pb, sb, kSweptTarget * thin);
        clear = 0;
        if (hit) {
          share = *hit;
          ta = frameAt(sa, share);
          tb = frameAt(sb, share);
          Manifold there;
          if (collide(pa, ta, pb, tb, margin, there)) {
            manifold = there;
          } else if (isNear) {  // a corner in a notch: seen from there, it belongs to the next piece
            share = 0;
            ta = fa;
            tb = fb;
          } else {
            return;
          }
        } else if (!isNear) {
          return;
        }
        passes = !hit;
      }
    } else if (!collide(pa, fa, pb, fb, margin, manifold)) {
      clear = std::min(clear, manifold.apart);
      return;
    }
    clear = 0;
    if (mayGraze && grazes(pa, ta, pb, tb, velocity, manifold.normal, kFlush * thin)) return;
    Contact& contact = found.emplace_back();
    contact.a = key.a;
    contact.b = key.b;
    contact.pieceA = pieces.a;
    contact.pieceB = pieces.b;
    contact.normal = manifold.normal;
    contact.sx = key.sx;
    contact.sy = key.sy;
    contact.count = static_cast<std::int8_t>(manifold.count);
    contact.face = static_cast<std::int8_t>(manifold.face);
    setSurfaces(bodies, contact);
    for (int k = 0; k < manifold.count; ++k) {
      ContactPoint& p = contact.points[k];
      p.armA = manifold.points[k].point - ta.position;
      p.armB = manifold.points[k].point - tb.position;
      contact.feature[k] = manifold.points[k].feature;
      const double speed = partingSpeed(bodies, contact, p);
      contact.approach = std::max(contact.approach, -speed);
      // One that goes round the other's corner may get behind the line of an edge on its way.
      const double gap = passes ? std::max(manifold.points[k].gap, kSweptTarget * thin - rest * speed)
                                : manifold.points[k].gap;
      // As of the step's start, by the same straight-line rule that brings it up to date.
      p.gap = gap - share * rest * speed - gapMoved(bodies, contact, p) -
              dot(contact.normal, aheadB.linear() - aheadA.linear()) -
              aheadB.turn * cross(p.armB, contact.normal) + aheadA.turn * cross(p.armA, contact.normal);
      p.armA = p.armA + later.time * bodies.velocity[key.a].linear();
      p.armB = p.armB + later.time * bodies.velocity[key.b].linear();
    }
  };
  const ConvexPiece *onlyA = bodies.extent[key.a].only, *onlyB = bodies.extent[key.b].only;
  if (onlyA && onlyB) {  // meet() looks first whether they are near
    meet(*onlyA, *onlyB, {0, 0});
    return clear;
  }
  clear = margin;
  const BodyShape &shapeA = *bodies.def[key.a].shape, &shapeB = *bodies.def[key.b].shape;
  findPiecePairs(shapeA, fa, shapeB, fb, margin, pieces_);
  for (const PiecePair& pair : pieces_) meet(shapeA.pieces[pair.a], shapeB.pieces[pair.b], pair);
  return clear;
}

}  // namespace smokebox

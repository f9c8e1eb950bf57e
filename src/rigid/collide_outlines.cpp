#include "rigid/collide_outlines.h"

#include <algorithm>

namespace smokebox::convex {
namespace {

/// The best edge on the outlines, for bodies of several pieces: it must be crossed by the other piece where
/// that overlaps, lest a piece be pushed out through its own body to the far side.
struct OutlineChoice {
  Manifold manifold, fallback;
  double separation = -1e300, fallbackSeparation = -1e300;
  bool inNotch = false;
};

void chooseOutline(const Side& side, const Frame& referenceInOther, double margin, OutlineChoice& choice) {
  const ConvexPiece &p = side.reference, &q = side.other;
  const int n = static_cast<int>(p.normals.size());
  // A corner that sinks in at the bottom of a notch is behind both edges there, whichever piece it is in.
  const double shallow = std::min({margin, p.notchReach, q.within});
  int at = 0;
  for (int k = 0; k < n; ++k) {
    if (p.inner[k]) continue;
    const Vec2 normal = p.normals[k];
    at = supportFrom(q, -inverseRotate(side.otherInReference.turn, normal), at);
    const double separation = dot(normal, toWorld(side.otherInReference, q.points[at]) - p.points[k]);
    if (separation <= choice.separation) continue;
    Manifold manifold;
    if (!faceOnOutline(side, k, at, margin, manifold)) continue;
    const bool inNotch = separation > -shallow && (isNotch(p, k) || isNotch(p, next(p, k)));
    const bool crossed =
        separation > 0 || inNotch ||
        meets(q, toWorld(referenceInOther, p.points[k]), toWorld(referenceInOther, p.points[next(p, k)]));
    if (crossed) {
      choice.separation = separation;
      choice.inNotch = inNotch;
      choice.manifold = manifold;
    } else if (separation > choice.fallbackSeparation) {
      choice.fallbackSeparation = separation;
      choice.fallback = manifold;
    }
  }
}

/// The nearest edge of the reference's outline, whatever it meets: one point, where the other is deepest
/// behind it.
void nearestOutline(const Side& side, OutlineChoice& choice) {
  const ConvexPiece &p = side.reference, &q = side.other;
  for (std::size_t k = 0; k < p.normals.size(); ++k) {
    if (p.inner[k]) continue;
    const Vec2 normal = p.normals[k];
    const int corner = support(q, -inverseRotate(side.otherInReference.turn, normal));
    const Vec2 at = toWorld(side.otherInReference, q.points[corner]);
    const double separation = dot(normal, at - p.points[k]);
    if (separation <= choice.fallbackSeparation) continue;
    choice.fallbackSeparation = separation;
    cornerOnFace(side, static_cast<int>(k), corner, choice.fallback);
  }
}

}  // namespace

bool collideOutlines(const Side& ab, const Side& ba, double separation, double margin, Manifold& manifold) {
  OutlineChoice choice;
  chooseOutline(ab, ba.otherInReference, margin, choice);
  chooseOutline(ba, ab.otherInReference, margin, choice);
  const bool found = choice.manifold.count > 0;
  // An overlap that is far deeper than that of the two pieces goes through a neighbouring piece, which has it
  // too; unless this one is swallowed.
  constexpr double kFar = 10, kSwallowed = 0.2;
  if (separation >= -kSwallowed * std::min(ab.reference.reach, ba.reference.reach)) {
    if (found && (choice.inNotch || choice.separation >= std::min(0.0, kFar * separation)))
      manifold = choice.manifold;
    return manifold.count > 0;
  }
  // Out of what swallowed it by the nearest edge, never across a whole wall.
  constexpr double kFarther = 2;
  nearestOutline(ab, choice);
  nearestOutline(ba, choice);
  const bool near = found && choice.separation >= kFarther * choice.fallbackSeparation;
  manifold = near ? choice.manifold : choice.fallback;
  return manifold.count > 0;
}

}  // namespace smokebox::convex

// How a contact of two pieces is put together: points with their gaps, seen from the piece that gives the
// normal.
#pragma once
#include <cstdint>

#include "rigid/collide.h"
#include "rigid/convex_queries.h"

namespace smokebox::convex {

/// Two pieces in the coordinates of one of them, the reference, whose edge or corner gives the normal.
struct Side {
  const ConvexPiece& reference;
  const Frame& frame;  // of the reference
  const ConvexPiece& other;
  const Frame& otherInReference;
  bool flipped;  // the reference is B
};

/// Edge or corner `onReference` with edge or corner `onOther`; `cornerOfReference`: the corner is the
/// reference's.
std::uint32_t featureOf(const Side& side, int onReference, int onOther, bool cornerOfReference);

/// `point` on the core of the other piece, `apart` from that of the reference along `normal` (coordinates of
/// the reference).
void addPoint(const Side& side, Vec2 point, double apart, Vec2 normal, std::uint32_t feature,
              Manifold& manifold);
void setNormal(const Side& side, Vec2 normal, Manifold& manifold);

/// One point: `point` of the other's core against `nearest` of the reference's, which are `apart`.
void touchCorner(const Side& side, Vec2 nearest, Vec2 point, double apart, std::uint32_t feature,
                 Manifold& manifold);

/// After touchCorner() of two corners: a second point, on the edges that run beside each other from there,
/// where these are nearest to meeting if the bodies turn. None beyond `margin`.
void edgesBeside(const Side& side, int corner, int otherCorner, Vec2 normal, double margin,
                 Manifold& manifold);

/// One point: corner `corner` of the other against the line of edge `k` of the reference.
void cornerOnFace(const Side& side, int k, int corner, Manifold& manifold);

/// Contact of edge `k`, on the outline, with what the other piece has on its own outline at its supported
/// corner: an edge that runs against it, which is clipped to edge `k`, or the corner if it can be touched
/// from there. Points farther than `margin` are left out; false if none is left.
bool faceOnOutline(const Side& side, int k, int supported, double margin, Manifold& manifold);

}  // namespace smokebox::convex

// A shape made ready for collisions: convex pieces, outlines, mass properties, a tree of boxes.
// Circles and capsules stay round, in unions too; ellipses become polygons of at least 64 corners; other
// polygons are cut into convex pieces by their own corners (ear clipping, then diagonals that no corner needs
// are taken out: Hertel and Mehlhorn 1983, at most 4 times as many pieces as needed).
#pragma once
#include <vector>

#include "geometry/shape.h"
#include "rigid/convex.h"
#include "rigid/piece_tree.h"

namespace smokebox {

struct BodyShape {
  std::vector<ConvexPiece> pieces;
  std::vector<Outline> outlines;  // whole body, own coordinates, for pictures and for the fluid
  MassProperties mass;  // of unit density; exact for circles, capsules and ellipses, and unions of such that
                        // do not overlap, else of the merged outlines
  double reach = 0;     // from (0, 0) to the farthest point
  double thinnest = 0;  // smallest width of a convex or round part; of others the smallest depth behind the
                        // middle of an edge
  PieceTree tree;
};

/// For a body, which turns about its centre of mass: `offset` receives that, in the coordinates in which
/// `shape` is given (its pose applied). `tolerance`: of curves in outlines, metres.
BodyShape makeBodyShape(const PlacedShape& shape, double tolerance, Vec2& offset);
/// For a solid, which turns about the (0, 0) of the coordinates in which `shape` is given; mass.centre is
/// then not 0.
BodyShape makeSolidShape(const PlacedShape& shape, double tolerance);

/// The region within outlines (holes clockwise) as convex pieces; edges that are not on an outline are inner.
std::vector<ConvexPiece> convexPieces(const std::vector<Outline>& outlines);

}  // namespace smokebox

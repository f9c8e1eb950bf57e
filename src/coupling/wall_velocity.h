// The velocity of what closes each face, along the face's normal.
#pragma once
#include "coupling/solids_on_grid.h"

namespace smokebox {

/// What coupling code asks of the solids and their images.
struct CoveredBy {
  const std::vector<MovingSolid>& solids;
  const std::vector<SolidsOnGrid::Copy>& copies;
  const GridCover& geometry;
  /// Of each copy: those that it may overlap and that move otherwise.
  const std::vector<std::vector<int>>& partners;
  double h;

  /// Where others overlap it the mean of all there: which of them a surface belongs to is not the same in
  /// mirror images. Rounded where motions all but add up to 0.
  Vec2 velocityAt(int copy, Vec2 p) const;

 private:
  bool covers(int copy, Vec2 p) const;
};

/// Sets boundary.wallU, wallV from the solids and the sides. The weights are all 0, and are so again
/// afterwards.
void setWallVelocities(const CoveredBy& by, Boundary& boundary, FaceWeights& ofU, FaceWeights& ofV);

/// Copies what lies beyond periodic sides from the other side, 0 beyond the others; repeats column nx, row
/// ny.
void wrapFaces(const Boundary& boundary, bool xFaces, Field& field);
void wrapCells(const Boundary& boundary, Field& field);

}  // namespace smokebox

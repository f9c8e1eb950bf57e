// What the coupling asks of the solids and their images: how that which closes a face, or ends a link, moves
// there, and how it holds the fluid.
//
// An edge of solids that were merged is labelled with one of them, and in mirror images that may be another
// one. So in a group of solids that may overlap and are not all alike a label only names the group: what
// counts is the mean of all of the group that cover a place or, where none does (a part of a face that is
// shut), of those nearest to it. Solids by themselves, and groups of like ones, go by their labels.
#pragma once
#include <vector>

#include "coupling/mixed_groups.h"
#include "coupling/solids_on_grid.h"

namespace smokebox {

/// The nearest whole multiple of 2^-36 of `largest`: where a sum of things that large all but adds up to 0,
/// the rounding of positions would show, and part mirror images.
double rounded(double value, double largest);

struct CoveredBy {
  const std::vector<MovingSolid>& solids;
  const std::vector<SolidsOnGrid::Copy>& copies;
  const GridCover& geometry;
  const MixedGroups& mixed;
  Grid grid;

  struct Surface {
    Vec2 velocity;  // rounded where motions all but add up to 0
    double drag = 0;
    int solid = -1;  // on whom its force acts
  };
  Surface at(int label, Vec2 p) const;
  /// Of two labels: the mean.
  Surface at(int label, int other, Vec2 p) const;
  /// At its middle.
  Surface at(const ShutPart& part) const;

 private:
  Surface meanOfGroup(int label, Vec2 p) const;
  static Surface mean(const Surface& a, const Surface& b);
  double distanceTo(int copy, Vec2 p) const;
};

}  // namespace smokebox

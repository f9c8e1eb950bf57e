// Cells that are too small for the step are merged with the neighbour behind their largest open face: a
// cluster shares one value during the sweeps. Merged are cells with less than a quarter of their area open,
// and cut cells out of which more than 95% of the volume would flow in one sweep. Mirror images are dealt
// with at once and so make mirrored clusters.
#pragma once
#include <cstdint>
#include <vector>

#include "fluid/mirror_search.h"
#include "fluid/smoke_cells.h"
#include "fluid/sweep.h"

namespace smokebox {

class CellClusters {
 public:
  /// Finds the clusters of this step among the cut cells, `nodes` being these and others to look after, and
  /// returns how many equal parts the step needs so that neither they nor the other cut cells are overdrawn
  /// (at least `parts`). Flows that would need more than `mostParts`, or would empty a cell, are reduced in
  /// courantX and courantY.
  int build(const SmokeCells& cells, const std::vector<int>& cut, const std::vector<int>& nodes,
            const Boundary& boundary, const Field& before, const Field& start, Field& courantX,
            Field& courantY, int parts, int mostParts);
  void clear(const SmokeCells& cells);

  /// The nodes, and the cells that get less because flows were reduced.
  const std::vector<int>& nodes() const { return nodes_; }

  int count() const { return static_cast<int>(first_.size()) - 1; }
  /// Cells of cluster k; the first is the one with corrected fluxes, unless all are merged.
  const int* begin(int k) const { return members_.data() + first_[k]; }
  const int* end(int k) const { return members_.data() + first_[k + 1]; }
  /// Whether the cell is merged into another one, or with its own image.
  bool merged(int cell) const { return !link_.empty() && link_[cell] != kNone; }
  /// Whether it belongs to a cluster at all.
  bool clustered(int cell) const { return !cluster_.empty() && cluster_[cell] >= 0; }

  /// Roots by row, with copies in the margins of periodic sides.
  const RowList<ClusterRoot>& roots(Axis axis) const { return axis == Axis::x ? rootsX_ : rootsY_; }

  std::size_t bytes() const;

 private:
  static constexpr int kNone = -1, kMerged = -2;  // a root that is one among its images

  int root(int cell) const;
  void group();
  int partner(const SmokeCells& cells, const Boundary& boundary, const Field& start, int cell, int image,
              const Images& but) const;
  void link(const SmokeCells& cells, const Boundary& boundary, const Field& start, const Images& images,
            unsigned which);
  void join(int cell, int other);
  void listRoots(const SmokeCells& cells);

  MirrorOrbits orbits_;
  std::vector<int> link_, cluster_;    // by cell, -1 for none
  std::vector<std::uint8_t> watched_;  // by cell: is in nodes_
  std::vector<int> nodes_;             // cells to look after
  std::vector<int> members_, first_{0}, linked_, placed_, roots_;
  RowList<ClusterRoot> rootsX_, rootsY_;
  struct RootPlace {
    int j;
    ClusterRoot root;
  };
  std::vector<RootPlace> places_;  // while they are sorted
};

/// The faces whose 7th-order stencil meets a cut cell or a face that is not fully open; found anew when
/// fractions change.
class IrregularFaces {
 public:
  /// Cells whose open share is not 1 now or was not before, or that carry another volume than 1, in order,
  /// into `cut`; and the faces around them.
  void find(const SmokeCells& cells, const Boundary& boundary, const Field& before, const Field& carried,
            std::vector<int>& cut);
  /// Decides which stencil each face takes.
  void choose(const SmokeCells& cells, const Boundary& boundary, const CellClusters& clusters);
  const RowList<IrregularFace>& faces(Axis axis) const { return axis == Axis::x ? x_ : y_; }
  std::size_t bytes() const;

 private:
  void mark(const SmokeCells& cells, Axis axis, int i, int j, int below, int above);
  void collect(const SmokeCells& cells, Axis axis);
  std::vector<std::uint8_t> marksX_, marksY_;
  RowList<IrregularFace> x_, y_;
};

}  // namespace smokebox

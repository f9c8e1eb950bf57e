// What all colours of smoke share in one step: the volumes that the cells start with and that flow through
// the faces, what the moving solids push from cell to cell, the merged cells and the faces that need care.
#pragma once
#include <vector>

#include "base/threads.h"
#include "fluid/boundary.h"
#include "fluid/smoke_merge.h"
#include "fluid/smoke_transfer.h"
#include "fluid/sweep.h"

namespace smokebox {

class SmokeVolumes {
 public:
  static constexpr int kMostParts =
      64;  // flows that would need more are slowed down: stable, conservative, wrong

  explicit SmokeVolumes(const Boundary& boundary);

  /// Plans one step from the geometry of the last call to boundary's. u, v: free of divergence in the new
  /// geometry.
  void prepare(const Boundary& boundary, const Field& u, const Field& v, double dt, ThreadPool& pool);
  /// The new geometry becomes the old one.
  void finish(const Boundary& boundary);

  const SmokeCells& cells() const { return cells_; }
  /// The step is done in this many equal parts.
  int parts() const { return parts_; }
  /// Volume through the low face of each cell in one part, in cells; margins filled.
  const Field& courant(Axis axis) const { return axis == Axis::x ? courantX_ : courantY_; }
  /// Open shares to start with; 1 where a cell stays closed.
  Field& start() { return start_; }
  /// Open shares at the end; 0 in clusters, whose values are found apart.
  const Field& measure(const Boundary& boundary) const { return nodes_.empty() ? boundary.volume : measure_; }
  /// next = volume after a sweep that starts with `volume`.
  void advance(Axis axis, const Field& volume, Field& next, ThreadPool& pool) const;

  bool moved() const { return moved_; }
  /// Cells that are cut before or after, and those that a transfer touches.
  const std::vector<int>& nodes() const { return nodes_; }
  TransferPlan& plan() { return plan_; }
  const CellClusters& clusters() const { return clusters_; }
  const IrregularFaces& irregular() const { return irregular_; }
  std::size_t bytes() const;

 private:
  float flows(const Boundary& boundary, const Field& u, const Field& v, double dt, ThreadPool& pool);
  void scale(float factor, ThreadPool& pool);
  void listNodes();

  SmokeCells cells_;
  Field courantX_, courantY_, start_, measure_;
  Field openXBefore_, openYBefore_, volumeBefore_;
  std::vector<int> cut_, nodes_;
  std::vector<std::uint8_t> listed_;  // by cell: is in nodes_; for moving solids only
  TransferPlan plan_;
  CellClusters clusters_;
  IrregularFaces irregular_;
  std::vector<float> drained_;  // by row, largest net outflow from a full cell
  std::uint64_t version_ = 0;
  bool moved_ = false, stale_ = true;
  int parts_ = 1;
};

/// Fills the four margins along an axis from the other side of a periodic domain.
void wrapMargin(Field& field, Axis axis, int nx, int ny, bool faces);

}  // namespace smokebox

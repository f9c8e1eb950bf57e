// What all colours of smoke share in one step: the volumes that the cells start with and that flow through
// the faces, what the moving solids push from cell to cell, the merged cells and the faces that need care.
#pragma once
#include <algorithm>
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

  /// Volume of smoke and air that each cell carries between steps: its open share as far as the solids'
  /// motion lets the two agree; 1 in closed cells.
  const Field& carried() const { return start_; }
  /// At least as much as any cell starts the sweeps with, and at least 1.
  float mostCarried() const { return mostCarried_; }

  /// Plans one step from the geometry of the last call to boundary's. u, v: free of divergence in the new
  /// geometry. `active`: where there is smoke of any colour. While no solid moves only the flows near it are
  /// found, and only they count.
  void prepare(const Boundary& boundary, const Field& u, const Field& v, double dt, const Activity& active,
               ThreadPool& pool);
  /// Before the last sweep, which starts with `volume`: what values are measured by afterwards.
  void settle(const Boundary& boundary, Axis axis, const SweptVolumes& volume);
  /// After it: carried() is what the step ends with.
  void commit(const Boundary& boundary);
  /// The new geometry becomes the old one.
  void finish(const Boundary& boundary);

  const SmokeCells& cells() const { return cells_; }
  /// The step is done in this many equal parts.
  int parts() const { return parts_; }
  /// Volume through the low face of each cell in one part, in cells; margins filled.
  const Field& courant(Axis axis) const { return axis == Axis::x ? courantX_ : courantY_; }
  /// Volumes to start with; 1 where a cell stays closed.
  const Field& start() const { return start_; }
  /// The same for the sweeps, none of them done.
  SweptVolumes swept() const;
  /// What values are measured by after the last sweep; 0 in clusters, whose values are found apart.
  const Field& measure(const Boundary& boundary) const { return nodes_.empty() ? boundary.volume : measure_; }
  /// Open shares at the end of the last step.
  const Field& openShare() const { return volumeBefore_; }

  /// What cluster k as a whole carries after the last sweep.
  double clusterCarried(int k) const { return clusterCarried_[k]; }

  bool moved() const { return moved_; }
  /// Solids have moved, or cells still carry more or less than they hold.
  bool carries() const { return moved_ || loose_; }
  /// Cells that are cut before or after, and those that a transfer touches.
  const std::vector<int>& nodes() const { return nodes_; }
  TransferPlan& plan() { return plan_; }
  /// Which regions of the last step's geometry go on as which.
  const RegionMatch& match() const { return match_; }
  const RegionMap& regionsBefore() const { return regionsBefore_; }
  const CellClusters& clusters() const { return clusters_; }
  const IrregularFaces& irregular() const { return irregular_; }
  std::size_t bytes() const;

 private:
  float flows(const Boundary& boundary, const Field& u, const Field& v, double dt, ThreadPool& pool);
  void scale(float factor, ThreadPool& pool);
  void listNodes();
  void findWindows(const Activity& active, int reach);
  int plan(const Boundary& boundary, const Field& u, const Field& v, double dt, ThreadPool& pool);
  void wrapMargins(Field& field) const;
  bool inWindow(int i, int j) const {
    const Window& w = windows_[j / kWindowRows];
    return i >= w.begin && i < w.end;
  }

  /// The columns in which the flows of some rows are wanted.
  struct Window {
    int begin = 0, end = 0;
    void join(Window o) {
      if (o.begin >= o.end) return;
      *this = begin >= end ? o : Window{std::min(begin, o.begin), std::max(end, o.end)};
    }
  };
  static constexpr int kWindowRows = 32;

  SmokeCells cells_;
  std::vector<Window> windows_, smoky_;  // by kWindowRows rows
  Field courantX_, courantY_, start_, measure_;
  Field openXBefore_, openYBefore_, volumeBefore_;
  RegionMap regionsBefore_;
  RegionMatch match_;
  std::vector<int> cut_, near_, nodes_, exchanging_;  // near_: those of cut_ in the windows
  std::vector<float> ends_;           // by place in nodes_: what they carry after the last sweep
  std::vector<std::uint8_t> listed_;  // by cell: is in nodes_; for moving solids only
  TransferPlan plan_;
  CellClusters clusters_;
  IrregularFaces irregular_;
  std::vector<double> clusterCarried_;
  std::vector<float> drained_;  // by row, largest net outflow from a full cell
  std::uint64_t version_ = 0;
  float mostCarried_ = 1;
  bool moved_ = false, stale_ = true;
  bool loose_ = false, looseAfter_ = false;  // some cell carries more or less than it holds
  int parts_ = 1;
};

/// Fills the four margins of a field at cell centres along an axis from the other side of a periodic domain.
void wrapMargin(Field& field, Axis axis, int nx, int ny);

}  // namespace smokebox

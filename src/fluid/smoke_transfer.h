// What moves from cell to cell because solids moved, before the smoke is swept along with the fluid.
//
// The fluxes of a step change the volume of fluid in a cell by minus their net sum; the solids change it from
// the old open share to the new one. The two agree over a neighbourhood but not in each cell. Here volume
// goes, with the smoke in it, from cells that would end with too much to cells near by that would end with
// too little, and a cell that closes hands on all that it has: to cells that it was connected with if there
// are any, then to the nearest open one.
#pragma once
#include <vector>

#include "fluid/smoke_cells.h"

namespace smokebox {

struct SmokeTransfer {
  int from = 0, to = 0;  // to = -1: no open cell in reach, the smoke is kept aside
  float share = 1;       // of the smoke that is in `from` when it is this transfer's turn; 1 means all
};

struct SmokeGeometry {
  const Field *openX = nullptr, *openY = nullptr, *volume = nullptr;
};

class TransferPlan {
 public:
  /// `cut`: cells whose share differs from 1 before or after. `start`: open shares before, changed to what
  /// the sweeps start with. Courant numbers as in SweepJob, for the whole step.
  void plan(const SmokeCells& cells, const std::vector<int>& cut, const SmokeGeometry& before,
            const SmokeGeometry& after, Field& courantX, Field& courantY, Field& start);
  const std::vector<SmokeTransfer>& transfers() const { return transfers_; }
  void clear() { transfers_.clear(); }
  std::size_t bytes() const;

  /// Nearest open cell by steps between neighbours, whatever lies between; -1 if there is none in reach.
  int nearestOpen(const SmokeCells& cells, const Field& volume, int from);

 private:
  enum class Through { after, either, all };
  /// Cells by distance from `from`, not itself, at most `most`, into found_.
  void search(const SmokeCells& cells, int from, Through through, const SmokeGeometry& before,
              const SmokeGeometry& after, int most);
  void route(const SmokeCells& cells, int from, int to, float volume, Field& courantX, Field& courantY);
  void give(int from, int to, float volume, bool all);

  std::vector<SmokeTransfer> transfers_;
  std::vector<float> excess_, content_;       // by cell; excess is 0 outside the list
  std::vector<int> seen_, found_, cameFrom_;  // cameFrom_: by cell, 4 times the cell before it, plus the face
  int search_ = 0;
};

}  // namespace smokebox

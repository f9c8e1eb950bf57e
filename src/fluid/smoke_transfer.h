// What moves from cell to cell because solids moved.
//
// Each cell near a solid carries a volume beside its smoke: what the fluxes of the steps so far left in it.
// It follows the open share of the cell, but not exactly, since fluxes are those of one moment and the solid
// moves on through the step. Before the sweeps a cell that closes hands all it has to cells that it was
// connected with, and so does one that a thin wall has passed (the part of it that counts as open is now on
// the wall's other side: in a region that does not continue the one it was in, or, where both sides are one
// region, among other cells than before). Fluxes near the solid are corrected along the way from cells that
// would end with too much to the nearest that would end with too little. After the sweeps volume goes, with
// the smoke in it, from cells that carry too much to cells near by that carry too little. Volume and smoke
// always go together, so a uniform field stays uniform and no value leaves its bounds; what finds no partner
// near by is carried on.
//
// Each cell is dealt with together with its mirror images, and takes and gives no more than its share of what
// several of them are at: mirror images stay such, to the bit.
//
// Nothing is handed from region to region. Limits: a thin wall with open ends that passes a whole cell in one
// step passes its smoke as well.
#pragma once
#include <cstdint>
#include <vector>

#include "fluid/mirror_search.h"
#include "fluid/region_match.h"
#include "fluid/smoke_cells.h"

namespace smokebox {

struct SmokeTransfer {
  int from = 0, to = 0;      // to = -1: no open cell in reach, the smoke is kept aside
  float share = 1;           // of the smoke that is in `from` when it is the turn of this transfer's group
  std::uint8_t drawing = 1;  // how many of its group have the same `from`
  bool all = false;          // these leave nothing there
  bool grouped = false;      // the next one is of the same group: at once
};

struct SmokeGeometry {
  const Field *openX = nullptr, *openY = nullptr, *volume = nullptr;
  const RegionMap* regions = nullptr;
};

class TransferPlan {
 public:
  /// Before the sweeps. `cut`: cells whose share differs from 1 before or after, or that carry more or less
  /// than they hold. `carried`: changed to what the sweeps start with (1 in closed cells). Courant numbers as
  /// in SweepJob, for the whole step.
  void handOver(const SmokeCells& cells, const std::vector<int>& cut, const RegionMatch& match,
                const SmokeGeometry& before, const SmokeGeometry& after, Field& courantX, Field& courantY,
                Field& carried);
  const std::vector<SmokeTransfer>& handedOver() const { return handed_; }
  /// Cells that others draw on, which need not be in `cut`.
  const std::vector<int>& drawnOn() const { return drawnOn_; }

  /// After the sweeps, which left the volumes `carried` in the cells `nodes`; others have what they hold.
  void exchange(const SmokeCells& cells, const std::vector<int>& nodes, const SmokeGeometry& after,
                Field& carried);
  const std::vector<SmokeTransfer>& exchanged() const { return exchanged_; }

  void clear();
  std::size_t bytes() const;

  /// Nearest open cell by steps between neighbours, whatever lies between, in a region (-1: in any), as a
  /// mirror image of the cell would find it; -1 if there is none in reach.
  int nearestOpen(const SmokeCells& cells, const SmokeGeometry& geometry, int from, int region,
                  int image = 0);

 private:
  using Amounts = std::array<float, 4>;  // by image
  struct AddedFlow {
    bool x;  // through x-face (i, j), else through the y-face
    int i, j;
    float volume;
  };

  void reserve(const SmokeCells& cells);
  void start(const SmokeCells& cells, const Images& from, unsigned which, const SmokeGeometry* through,
             int most);
  void handOverFrom(const SmokeCells& cells, const Images& from, unsigned which, const RegionMatch& match,
                    const SmokeGeometry& before, const SmokeGeometry& after);
  void giveRest(const Images& from, unsigned which, const Images& to);
  void give(const Images& from, const Images& to, const Amounts& volume, unsigned which);
  void send(const SmokeCells& cells, const Images& from, const Images& to, const Amounts& volume,
            unsigned which);
  static void shift(const Images& from, const Images& to, const Amounts& volume, unsigned which,
                    std::vector<float>& amounts);
  void route(const SmokeCells& cells, int image, int from, int to, float volume);
  void addFlows(const SmokeCells& cells, Field& courantX, Field& courantY);
  void correctFlows(const SmokeCells& cells, const std::vector<int>& cut, const SmokeGeometry& after,
                    Field& courantX, Field& courantY);
  void endGroup(std::vector<SmokeTransfer>& transfers, std::size_t begin);

  std::vector<SmokeTransfer> handed_, exchanged_;
  std::vector<float> excess_, content_;  // by cell; 0 and 1 outside the list
  std::vector<std::uint8_t> passed_;     // by cell: a thin wall has passed it in this step
  MirrorSearch search_;
  MirrorOrbits orbits_;
  std::vector<int> path_, drawnOn_;
  std::vector<AddedFlow> flows_;
  std::vector<std::uint8_t> drawing_;  // by cell; 0 between uses
  std::vector<int> barren_;  // by cell: the last hand-over in which nothing was to be found around it
  int barrenNow_ = 0;
};

}  // namespace smokebox

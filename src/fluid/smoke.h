// Smoke of any number of colours, carried conservatively: split sweeps that move mass and volume together,
// 7th-order semi-Lagrangian fluxes, flux-corrected to stay between 0 and the largest value of the last
// hundred steps or so (Zalesak 1979 with the global bounds). What a moving solid sweeps up goes to the cells
// beside it and never vanishes; cells with less than a quarter of their area open are merged with a neighbour
// for the sweep.
//
// Mass is kept per cell in units of (smoke value) x (cell area): value = mass / open share. Sums are in m^2
// of smoke.
#pragma once
#include <memory>
#include <vector>

#include "base/color.h"
#include "base/threads.h"
#include "fluid/boundary.h"

namespace smokebox {

class Smoke {
 public:
  Smoke(const Boundary& boundary, ThreadPool& pool, int channels);
  ~Smoke();

  int channels() const;
  /// Smoke value (mass over open share) at the cell centres of one channel; 0 inside solids.
  const Field& value(int channel) const;

  /// Adds `amount` (smoke value) times share(i, j) to each cell; share: part of the cell's area inside the
  /// shape, 0..1. Nothing is added inside solids.
  void add(const Boundary& boundary, int channel, const Field& share, double amount);

  /// Carries all channels by the divergence-free u, v over dt, from the volumes of the last call (or the
  /// constructor) to boundary.volume, solids having moved in between.
  void transport(const Boundary& boundary, const Field& u, const Field& v, double dt);

  /// What is there, has been added, and has left through open sides, m^2 of smoke, all channels (float64 sums
  /// in a fixed order). Smallest and largest value over the cells and channels.
  struct Totals {
    double mass = 0, emitted = 0, left = 0, min = 0, max = 0;
  };
  Totals totals() const;

  std::size_t bytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace smokebox

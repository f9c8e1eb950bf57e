#include "fluid/smoke_transfer.h"

#include <algorithm>

namespace smokebox {
namespace {
constexpr float kTolerance = 1e-6f;
constexpr int kReachOfClosed = 128;  // cells looked at
constexpr int kReachOfExcess = 40, kFarReach = 800;
constexpr float kAlmostFull = 0.5f;  // open share of a cell that a thick solid is about to fill
constexpr int kReachOfDeficit = 12;
}  // namespace

std::size_t TransferPlan::bytes() const {
  return transfers_.capacity() * sizeof(SmokeTransfer) +
         (excess_.capacity() + content_.capacity()) * sizeof(float) +
         (seen_.capacity() + cameFrom_.capacity() + found_.capacity()) * sizeof(int);
}

void TransferPlan::search(const SmokeCells& cells, int from, Through through, const SmokeGeometry& before,
                          const SmokeGeometry& after, int most) {
  found_.clear();
  ++search_;
  seen_[from] = search_;
  found_.push_back(from);
  for (std::size_t head = 0; head < found_.size() && static_cast<int>(found_.size()) <= most; ++head) {
    const int cell = found_[head], i = cells.i(cell), j = cells.j(cell);
    for (int face = 0; face < 4; ++face) {
      const bool passes =
          through == Through::all || SmokeCells::atFace(*after.openX, *after.openY, i, j, face) > 0 ||
          (through == Through::either && SmokeCells::atFace(*before.openX, *before.openY, i, j, face) > 0);
      if (!passes) continue;
      const int next = cells.neighbour(cell, face);
      if (next < 0 || seen_[next] == search_) continue;
      seen_[next] = search_;
      cameFrom_[next] = 4 * cell + face;
      found_.push_back(next);
    }
  }
  found_.erase(found_.begin());
}

int TransferPlan::nearestOpen(const SmokeCells& cells, const Field& volume, int from) {
  seen_.resize(static_cast<std::size_t>(cells.nx) * cells.ny, 0);
  cameFrom_.resize(seen_.size(), 0);
  if (volume(cells.i(from), cells.j(from)) > 0) return from;
  search(cells, from, Through::all, {}, {}, kReachOfClosed);
  for (int cell : found_)
    if (volume(cells.i(cell), cells.j(cell)) > 0) return cell;
  return -1;
}

// Moves a volume and notes which share of the smoke goes with it.
void TransferPlan::give(int from, int to, float volume, bool all) {
  const float share = all ? 1.0f : std::min(1.0f, volume / content_[from]);
  transfers_.push_back({from, to, share});
  content_[from] -= volume;
  excess_[from] -= volume;
  if (to < 0) return;
  content_[to] += volume;
  excess_[to] += volume;
}

// Sends a volume along the path that the last search, which began at `from`, took to `to`.
void TransferPlan::route(const SmokeCells& cells, int from, int to, float volume, Field& courantX,
                         Field& courantY) {
  excess_[from] -= volume;
  excess_[to] += volume;
  for (int cell = to; cell != from;) {
    const int last = cameFrom_[cell] / 4, face = cameFrom_[cell] % 4, i = cells.i(last), j = cells.j(last);
    float& flow = SmokeCells::atFace(courantX, courantY, i, j, face);
    flow += outwards(face) * volume;
    // The two copies of a periodic side's faces agree.
    if (cells.periodicX && face == 0 && i == 0) courantX(cells.nx, j) = flow;
    if (cells.periodicX && face == 1 && i == cells.nx - 1) courantX(0, j) = flow;
    if (cells.periodicY && face == 2 && j == 0) courantY(i, cells.ny) = flow;
    if (cells.periodicY && face == 3 && j == cells.ny - 1) courantY(i, 0) = flow;
    cell = last;
  }
}

void TransferPlan::plan(const SmokeCells& cells, const std::vector<int>& cut, const SmokeGeometry& before,
                        const SmokeGeometry& after, Field& courantX, Field& courantY, Field& start) {
  const std::size_t count = static_cast<std::size_t>(cells.nx) * cells.ny;
  excess_.resize(count, 0);
  content_.resize(count, 1);
  seen_.resize(count, 0);
  cameFrom_.resize(count, 0);
  transfers_.clear();
  auto volumeBefore = [&](int c) { return (*before.volume)(cells.i(c), cells.j(c)); };
  auto volumeAfter = [&](int c) { return (*after.volume)(cells.i(c), cells.j(c)); };

  for (int c : cut) {
    float net = 0;
    for (int face = 0; face < 4; ++face) net += outwards(face) * cells.atFace(courantX, courantY, c, face);
    content_[c] = volumeBefore(c);
    excess_[c] = volumeBefore(c) - net - volumeAfter(c);
  }

  // A thin wall has passed from one side of a cell to the other: its content goes on ahead of the wall.
  for (int c : cut) {
    if (!(volumeBefore(c) > 0 && volumeAfter(c) > 0)) continue;
    int shutTo = -1;
    bool opened = false;
    for (int face = 0; face < 4; ++face) {
      const float was = cells.atFace(*before.openX, *before.openY, c, face);
      const float is = cells.atFace(*after.openX, *after.openY, c, face);
      const int next = cells.neighbour(c, face);
      if (next < 0) continue;
      if (was == 0 && is > 0) opened = true;
      if (was > 0 && is == 0 && volumeAfter(next) > 0 &&
          (shutTo < 0 || volumeAfter(next) > volumeAfter(shutTo)))
        shutTo = next;
    }
    if (opened && shutTo >= 0) give(c, shutTo, content_[c], true);
  }

  // Cells that close hand on everything.
  for (int c : cut) {
    if (volumeAfter(c) > 0 || volumeBefore(c) <= 0) continue;
    search(cells, c, Through::either, before, after, kReachOfClosed);
    int nearest = -1;
    for (int other : found_) {
      if (volumeAfter(other) <= 0) continue;
      if (nearest < 0) nearest = other;
      const float moved = std::min(excess_[c], -excess_[other]);
      if (moved > kTolerance) give(c, other, moved, false);
      if (excess_[c] <= kTolerance) break;
    }
    if (nearest < 0) nearest = nearestOpen(cells, *after.volume, c);
    // The rest, be it none: what is left of the smoke must not stay.
    give(c, nearest, std::max(content_[c], 0.0f), true);
  }

  // Open cells that would end with too much: correct the fluxes along the way to the nearest that lack some.
  for (const int reach : {kReachOfExcess, kFarReach})
    for (int c : cut) {
      if (volumeAfter(c) <= 0 || excess_[c] <= kTolerance) continue;
      search(cells, c, Through::after, before, after, reach);
      for (int other : found_) {
        const float moved = std::min(excess_[c], -excess_[other]);
        if (volumeAfter(other) > 0 && moved > kTolerance) route(cells, c, other, moved, courantX, courantY);
        if (excess_[c] <= kTolerance) break;
      }
    }
  // One that the solid has almost filled and shut in may reach back through faces that were open before.
  for (int c : cut) {
    if (volumeAfter(c) <= 0 || excess_[c] <= kTolerance || volumeAfter(c) > kAlmostFull) continue;
    search(cells, c, Through::either, before, after, kReachOfExcess);
    for (int other : found_) {
      const float moved = std::min({excess_[c], -excess_[other], 0.99f * content_[c]});
      if (volumeAfter(other) > 0 && moved > kTolerance) give(c, other, moved, false);
      if (excess_[c] <= kTolerance) break;
    }
  }
  // A cell that would end with less than half of its volume draws on others.
  for (int c : cut) {
    float lacks = -0.5f * volumeAfter(c) - excess_[c];
    if (volumeAfter(c) <= 0 || lacks <= kTolerance) continue;
    search(cells, c, Through::after, before, after, kReachOfDeficit);
    for (int other : found_) {
      const float moved = std::min(lacks, excess_[other] + 0.5f * volumeAfter(other));
      if (volumeAfter(other) <= 0 || moved <= kTolerance) continue;
      route(cells, c, other, -moved, courantX, courantY);
      lacks -= moved;
      if (lacks <= kTolerance) break;
    }
  }

  // Back to a clean slate for the next step; cells off the list may have been drawn on.
  auto settle = [&](int c) {
    if (c < 0) return;
    start(cells.i(c), cells.j(c)) = volumeAfter(c) > 0 ? std::max(content_[c], kTolerance) : 1.0f;
  };
  for (int c : cut) settle(c);
  for (const SmokeTransfer& t : transfers_) settle(t.from), settle(t.to);
  auto forget = [&](int c) {
    if (c < 0) return;
    excess_[c] = 0;
    content_[c] = 1;
  };
  for (int c : cut) forget(c);
  for (const SmokeTransfer& t : transfers_) forget(t.from), forget(t.to);
}

}  // namespace smokebox

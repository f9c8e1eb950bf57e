#include "fluid/smoke_transfer.h"

#include <algorithm>

namespace smokebox {
namespace {
constexpr float kTolerance = 1e-6f;
constexpr int kReachOfClosed = 128;              // cells looked at
constexpr int kReachOfPairs[] = {4, 12, 40};     // of cells that close
constexpr int kReachOfExchange[] = {4, 12, 40};  // the nearest partners first
constexpr int kReachOfFlows[] = {40, 800};
constexpr int kBarrenPart =
    4;  // of the cells that a wide search has seen: those that need no search of their own
constexpr int kReachOfDeficit = 12;
constexpr float kMostTaken = 0.95f;  // of what a cell carries
constexpr int kWindow = 2;           // cells to either side in which two sides are told apart

float volumeOf(const SmokeCells& cells, const SmokeGeometry& geometry, int c) {
  return (*geometry.volume)(cells.i(c), cells.j(c));
}

float smallest(float a, float b, float c) { return std::min(a, std::min(b, c)); }

float openOf(const SmokeCells& cells, const SmokeGeometry& geometry, int c, int face) {
  return cells.atFace(*geometry.openX, *geometry.openY, c, face);
}

int regionOf(const SmokeCells& cells, const SmokeGeometry& geometry, int c) {
  return geometry.regions ? geometry.regions->at(cells.i(c), cells.j(c)) : -1;
}

// Cells by their place in the window around one, of which some are never cut and so keep their side.
struct Window {
  static constexpr int kSize = 2 * kWindow + 1;
  std::uint32_t reached = 0, anchors = 0;

  void fill(const SmokeCells& cells, int from, const SmokeGeometry& through, const SmokeGeometry& before,
            const SmokeGeometry& after) {
    struct Place {
      int cell, x, y;
    };
    Place queue[kSize * kSize] = {{from, kWindow, kWindow}};
    int count = 1;
    reached = bit(kWindow, kWindow);
    for (int head = 0; head < count; ++head) {
      const Place p = queue[head];
      if (volumeOf(cells, before, p.cell) == 1 && volumeOf(cells, after, p.cell) == 1)
        anchors |= bit(p.x, p.y);
      for (int face = 0; face < 4; ++face) {
        const int x = p.x + (face == 1) - (face == 0), y = p.y + (face == 3) - (face == 2);
        if (x < 0 || y < 0 || x >= kSize || y >= kSize || (reached & bit(x, y))) continue;
        const int next = cells.neighbour(p.cell, face);
        if (next < 0 || !(openOf(cells, through, p.cell, face) > 0)) continue;
        reached |= bit(x, y);
        queue[count++] = {next, x, y};
      }
    }
  }
  static std::uint32_t bit(int x, int y) { return 1u << (y * kSize + x); }
};
}  // namespace

std::size_t TransferPlan::bytes() const {
  return (handed_.capacity() + exchanged_.capacity()) * sizeof(SmokeTransfer) + passed_.capacity() +
         (excess_.capacity() + content_.capacity()) * sizeof(float) +
         (seen_.capacity() + cameFrom_.capacity() + barren_.capacity() + queue_.capacity() +
          path_.capacity()) *
             sizeof(int);
}

void TransferPlan::clear() {
  handed_.clear();
  exchanged_.clear();
  drawnOn_.clear();
}

void TransferPlan::reserve(const SmokeCells& cells) {
  if (seen_.size() == cells.count()) return;
  excess_.assign(cells.count(), 0);
  content_.assign(cells.count(), 1);
  passed_.assign(cells.count(), 0);
  seen_.assign(cells.count(), 0);
  cameFrom_.assign(cells.count(), 0);
  barren_.assign(cells.count(), 0);
}

template <class Visit>
void TransferPlan::search(const SmokeCells& cells, int from, const SmokeGeometry* geometry, int most,
                          Visit&& visit) {
  queue_.assign(1, from);
  seen_[from] = ++search_;
  for (std::size_t head = 0; head < queue_.size() && static_cast<int>(queue_.size()) <= most; ++head) {
    const int cell = queue_[head], i = cells.i(cell), j = cells.j(cell);
    for (int face = 0; face < 4; ++face) {
      if (geometry && !(SmokeCells::atFace(*geometry->openX, *geometry->openY, i, j, face) > 0)) continue;
      const int next = cells.neighbour(i, j, face);
      if (next < 0 || seen_[next] == search_) continue;
      seen_[next] = search_;
      cameFrom_[next] = cell;
      queue_.push_back(next);
      if (visit(next)) return;
    }
  }
}

int TransferPlan::nearestOpen(const SmokeCells& cells, const SmokeGeometry& geometry, int from, int region) {
  reserve(cells);
  auto fits = [&](int c) {
    return volumeOf(cells, geometry, c) > 0 && (region < 0 || regionOf(cells, geometry, c) == region);
  };
  if (fits(from)) return from;
  int found = -1;
  search(cells, from, nullptr, kReachOfClosed, [&](int cell) {
    if (fits(cell)) found = cell;
    return found >= 0;
  });
  return found;
}

// Moves a volume and notes which share of the smoke goes with it.
void TransferPlan::give(int from, int to, float volume, bool all) {
  handed_.push_back({from, to, all ? 1.0f : std::min(1.0f, volume / content_[from])});
  content_[from] -= volume;
  excess_[from] -= volume;
  if (to < 0) return;
  content_[to] += volume;
  excess_[to] += volume;
}

// Whether the part of a cell that counts as open has changed from one side of a thin wall to the other: the
// cells that are never cut and that it is connected with near by are others now.
bool TransferPlan::passed(const SmokeCells& cells, int c, const SmokeGeometry& before,
                          const SmokeGeometry& after) {
  bool was = false, is = false, both = false;
  for (int face = 0; face < 4; ++face) {
    const int next = cells.neighbour(c, face);
    if (next < 0) continue;
    const bool wasOpen = openOf(cells, before, c, face) > 0, isOpen = openOf(cells, after, c, face) > 0;
    if (wasOpen && isOpen && volumeOf(cells, before, next) == 1 && volumeOf(cells, after, next) == 1)
      return false;
    was |= wasOpen;
    is |= isOpen;
    both |= wasOpen && isOpen;
  }
  if (!was) return false;
  if (!is) return true;  // shut in: whichever side it is on when it opens again
  Window old, now;
  old.fill(cells, c, before, before, after);
  now.fill(cells, c, after, before, after);
  return old.anchors && now.anchors ? (old.anchors & now.anchors) == 0 : !both;
}

void TransferPlan::handOver(const SmokeCells& cells, const std::vector<int>& cut, const RegionMatch& match,
                            const SmokeGeometry& before, const SmokeGeometry& after, Field& courantX,
                            Field& courantY, Field& carried) {
  reserve(cells);
  handed_.clear();
  drawnOn_.clear();
  for (int c : cut) {
    float net = 0;
    for (int face = 0; face < 4; ++face) net += outwards(face) * cells.atFace(courantX, courantY, c, face);
    content_[c] = volumeOf(cells, before, c) > 0 ? carried(cells.i(c), cells.j(c)) : 0.0f;
    excess_[c] = content_[c] - net - volumeOf(cells, after, c);
    const bool stays = volumeOf(cells, before, c) > 0 && volumeOf(cells, after, c) > 0;
    passed_[c] =
        stays &&
        ((match.apart() && !match.continues(regionOf(cells, before, c), regionOf(cells, after, c))) ||
         passed(cells, c, before, after));
  }

  for (int c : cut) {
    const bool closes = volumeOf(cells, before, c) > 0 && volumeOf(cells, after, c) <= 0;
    if (!closes && !passed_[c]) continue;
    const int region = match.apart() ? regionOf(cells, before, c) : -1;
    auto takes = [&](int other) {
      return volumeOf(cells, after, other) > 0 && !passed_[other] &&
             (region < 0 || match.continues(region, regionOf(cells, after, other)));
    };
    int nearest = -1;
    for (int reach : kReachOfPairs) {
      search(cells, c, &before, reach, [&](int other) {
        if (!takes(other)) return false;
        if (nearest < 0) nearest = other;
        if (content_[c] <= kTolerance) return true;
        const float moved = std::min(content_[c], -excess_[other]);
        if (moved > kTolerance) give(c, other, moved, false);
        return content_[c] <= kTolerance;
      });
      if (content_[c] <= kTolerance && nearest >= 0) break;
    }
    // Then whatever lies between, if it is told apart what is on which side.
    for (const SmokeGeometry* through : {&before, static_cast<const SmokeGeometry*>(nullptr)}) {
      if (nearest >= 0 || (!through && region < 0)) break;
      search(cells, c, through, kReachOfClosed, [&](int other) {
        if (takes(other)) nearest = other;
        return nearest >= 0;
      });
    }
    if (nearest < 0) {
      const int heir = region < 0 ? -1 : match.heir(region);
      if (passed_[c] && (region < 0 || match.continues(region, regionOf(cells, after, c)))) continue;
      if (heir < 0) nearest = nearestOpen(cells, after, c, -1);  // of a region that has vanished
    }
    // The rest, be it none: what is left of the smoke must not stay.
    give(c, nearest, std::max(content_[c], 0.0f), true);
  }

  correctFlows(cells, cut, after, courantX, courantY);

  // Back to a clean slate; cells off the list may have been given something.
  auto settle = [&](int c) {
    if (c < 0) return;
    carried(cells.i(c), cells.j(c)) =
        volumeOf(cells, after, c) > 0 ? std::max(content_[c], kTolerance) : 1.0f;
  };
  for (int c : cut) settle(c);
  for (const SmokeTransfer& t : handed_) settle(t.to);
  auto forget = [&](int c) {
    if (c < 0) return;
    excess_[c] = 0;
    content_[c] = 1;
    passed_[c] = 0;
  };
  for (int c : cut) forget(c);
  for (int c : drawnOn_) forget(c);
  for (const SmokeTransfer& t : handed_) forget(t.to);
}

// Adds a flow along the path that the last search, which began at `from`, took to `to`.
void TransferPlan::route(const SmokeCells& cells, int from, int to, float volume, Field& courantX,
                         Field& courantY) {
  excess_[from] -= volume;
  excess_[to] += volume;
  for (int cell = to; cell != from;) {
    const int last = cameFrom_[cell], i = cells.i(last), j = cells.j(last);
    int face = 0;
    while (face < 3 && cells.neighbour(last, face) != cell) ++face;
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

// Lets open cells that would end with too much flow into the nearest that lack some, and cells that would end
// with less than half of their volume draw on others.
void TransferPlan::correctFlows(const SmokeCells& cells, const std::vector<int>& cut,
                                const SmokeGeometry& after, Field& courantX, Field& courantY) {
  ++barrenNow_;
  for (const int reach : kReachOfFlows)
    for (int c : cut) {
      if (volumeOf(cells, after, c) <= 0 || excess_[c] <= kTolerance || barren_[c] == barrenNow_) continue;
      search(cells, c, &after, reach, [&](int other) {
        const float moved = std::min(excess_[c], -excess_[other]);
        if (moved > kTolerance && volumeOf(cells, after, other) > 0)
          route(cells, c, other, moved, courantX, courantY);
        return excess_[c] <= kTolerance;
      });
      // Where a wide search was in vain, the cells around need not try.
      if (excess_[c] <= kTolerance || reach != kReachOfFlows[1]) continue;
      for (std::size_t k = 0; k < queue_.size() / kBarrenPart; ++k) barren_[queue_[k]] = barrenNow_;
    }
  for (int c : cut) {
    const float open = volumeOf(cells, after, c);
    float lacks = -0.5f * open - excess_[c];
    if (open <= 0 || lacks <= kTolerance) continue;
    search(cells, c, &after, kReachOfDeficit, [&](int other) {
      const float has = volumeOf(cells, after, other);
      const float moved = std::min(lacks, excess_[other] + 0.5f * has);
      if (has <= 0 || moved <= kTolerance) return false;
      route(cells, c, other, -moved, courantX, courantY);
      drawnOn_.push_back(other);
      lacks -= moved;
      return lacks <= kTolerance;
    });
  }
}

// Sends a volume along the path that the last search, which began at `to`, took to `from`: each cell on the
// way passes on what it has, so that smoke moves by one cell rather than by the whole way.
void TransferPlan::send(int from, int to, float volume) {
  path_.clear();
  for (int c = from; c != to; c = cameFrom_[c]) path_.push_back(c);
  int last = to;
  for (int k = static_cast<int>(path_.size()) - 1; k >= 0; --k) {
    const int c = path_[k];
    if (k > 0 && content_[c] < 1.5f * volume) continue;
    exchanged_.push_back({c, last, std::min(1.0f, volume / content_[c])});
    last = c;
  }
  content_[from] -= volume;
  excess_[from] -= volume;
  content_[to] += volume;
  excess_[to] += volume;
}

void TransferPlan::exchange(const SmokeCells& cells, const std::vector<int>& nodes,
                            const SmokeGeometry& after, Field& carried) {
  reserve(cells);
  exchanged_.clear();
  for (int c : nodes) {
    const float open = volumeOf(cells, after, c);
    if (!(open > 0)) continue;
    content_[c] = carried(cells.i(c), cells.j(c));
    excess_[c] = content_[c] - open;
  }
  for (int reach : kReachOfExchange)
    for (int c : nodes) {
      if (volumeOf(cells, after, c) <= 0 || -excess_[c] <= kTolerance) continue;
      search(cells, c, &after, reach, [&](int other) {
        const float moved = smallest(-excess_[c], excess_[other], kMostTaken * content_[other]);
        if (moved > kTolerance && volumeOf(cells, after, other) > 0) send(other, c, moved);
        return -excess_[c] <= kTolerance;
      });
    }
  // A cell that carries less than half of what it holds draws on others.
  for (int c : nodes) {
    const float half = 0.5f * volumeOf(cells, after, c);
    if (half <= 0 || half - content_[c] <= kTolerance) continue;
    search(cells, c, &after, kReachOfExchange[1], [&](int other) {
      const float has = volumeOf(cells, after, other);
      const float moved = std::min(half - content_[c], content_[other] - 0.5f * has);
      if (has > 0 && moved > kTolerance) send(other, c, moved);
      return half - content_[c] <= kTolerance;
    });
  }
  auto settle = [&](int c) {
    const float open = volumeOf(cells, after, c);
    if (open > 0) carried(cells.i(c), cells.j(c)) = std::max(content_[c], kTolerance);
  };
  for (int c : nodes) settle(c);
  for (const SmokeTransfer& t : exchanged_) settle(t.from), settle(t.to);
  auto forget = [&](int c) {
    excess_[c] = 0;
    content_[c] = 1;
  };
  for (int c : nodes) forget(c);
  for (const SmokeTransfer& t : exchanged_) forget(t.from), forget(t.to);
}

}  // namespace smokebox

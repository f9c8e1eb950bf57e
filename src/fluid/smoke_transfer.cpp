#include "fluid/smoke_transfer.h"

#include <algorithm>

#include "fluid/smoke_passed.h"

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

float volumeOf(const SmokeCells& cells, const SmokeGeometry& geometry, int c) {
  return (*geometry.volume)(cells.i(c), cells.j(c));
}

int regionOf(const SmokeCells& cells, const SmokeGeometry& geometry, int c) {
  return geometry.regions ? geometry.regions->at(cells.i(c), cells.j(c)) : -1;
}

bool has(unsigned which, int image) { return which >> image & 1; }

/// The smaller of what a cell has to give and another can take, where as many share in either.
float shared(float gives, int givers, float takes, int takers) {
  return std::min(gives / static_cast<float>(givers), takes / static_cast<float>(takers));
}
}  // namespace

std::size_t TransferPlan::bytes() const {
  return (handed_.capacity() + exchanged_.capacity()) * sizeof(SmokeTransfer) + passed_.capacity() +
         drawing_.capacity() + (excess_.capacity() + content_.capacity()) * sizeof(float) +
         (barren_.capacity() + path_.capacity()) * sizeof(int) + search_.bytes() + orbits_.bytes();
}

void TransferPlan::clear() {
  handed_.clear();
  exchanged_.clear();
  drawnOn_.clear();
}

void TransferPlan::reserve(const SmokeCells& cells) {
  if (barren_.size() == cells.count()) return;
  excess_.assign(cells.count(), 0);
  content_.assign(cells.count(), 1);
  passed_.assign(cells.count(), 0);
  drawing_.assign(cells.count(), 0);
  barren_.assign(cells.count(), 0);
}

void TransferPlan::start(const SmokeCells& cells, const Images& from, unsigned which,
                         const SmokeGeometry* through, int most) {
  search_.start(cells, from, which, through ? through->openX : nullptr, through ? through->openY : nullptr,
                most);
}

int TransferPlan::nearestOpen(const SmokeCells& cells, const SmokeGeometry& geometry, int from, int region,
                              int image) {
  reserve(cells);
  auto fits = [&](int c) {
    return volumeOf(cells, geometry, c) > 0 && (region < 0 || regionOf(cells, geometry, c) == region);
  };
  if (fits(from)) return from;
  start(cells, {from, from, from, from}, 1u << image, nullptr, kReachOfClosed);
  for (Images found; search_.next(found);)
    if (fits(found[image])) return found[image];
  return -1;
}

// Moves volumes from cell to cell at once: those that are equal for mirror images are added in one order.
void TransferPlan::shift(const Images& from, const Images& to, const Amounts& volume, unsigned which,
                         std::vector<float>& amounts) {
  int order[4] = {0, 1, 2, 3};
  std::stable_sort(order, order + 4, [&](int a, int b) { return volume[a] > volume[b]; });
  for (int g : order) {
    if (!has(which, g)) continue;
    amounts[from[g]] -= volume[g];
    if (to[g] >= 0) amounts[to[g]] += volume[g];
  }
}

// The transfers from `begin` on happen at once.
void TransferPlan::endGroup(std::vector<SmokeTransfer>& transfers, std::size_t begin) {
  if (transfers.size() - begin < 2) return;
  for (std::size_t k = begin; k < transfers.size(); ++k) ++drawing_[transfers[k].from];
  for (std::size_t k = begin; k < transfers.size(); ++k) {
    transfers[k].drawing = drawing_[transfers[k].from];
    transfers[k].grouped = k + 1 < transfers.size();
  }
  for (std::size_t k = begin; k < transfers.size(); ++k) drawing_[transfers[k].from] = 0;
}

// Moves volumes at once and notes which share of the smoke goes with each.
void TransferPlan::give(const Images& from, const Images& to, const Amounts& volume, unsigned which) {
  const std::size_t begin = handed_.size();
  for (int g = 0; g < 4; ++g)
    if (has(which, g)) handed_.push_back({from[g], to[g], std::min(1.0f, volume[g] / content_[from[g]])});
  endGroup(handed_, begin);
  shift(from, to, volume, which, content_);
  shift(from, to, volume, which, excess_);
}

// What is left in cells, be it none, goes to the cells `to`; what is left of the smoke must not stay.
void TransferPlan::giveRest(const Images& from, unsigned which, const Images& to) {
  unsigned giving = 0;  // of images that are one cell those that have found another, or one
  for (int g = 0; g < 4; ++g) {
    if (!has(which, g)) continue;
    bool other = false;
    for (int k = 0; k < 4; ++k) other |= k != g && has(which, k) && from[k] == from[g] && to[k] >= 0;
    if (to[g] >= 0 || (!other && sharing(from, giving, g) == 0)) giving |= 1u << g;
  }
  Amounts rest = {};
  const std::size_t begin = handed_.size();
  for (int g = 0; g < 4; ++g) {
    if (!has(giving, g)) continue;
    rest[g] = std::max(content_[from[g]], 0.0f) / static_cast<float>(sharing(from, giving, g));
    handed_.push_back({from[g], to[g], 1.0f, 1, true});
  }
  endGroup(handed_, begin);
  shift(from, to, rest, giving, content_);
  shift(from, to, rest, giving, excess_);
}

void TransferPlan::handOver(const SmokeCells& cells, const std::vector<int>& cut, const RegionMatch& match,
                            const SmokeGeometry& before, const SmokeGeometry& after, Field& courantX,
                            Field& courantY, Field& carried) {
  reserve(cells);
  handed_.clear();
  drawnOn_.clear();
  for (int c : cut) {
    const float netX = cells.atFace(courantX, courantY, c, 1) - cells.atFace(courantX, courantY, c, 0),
                netY = cells.atFace(courantX, courantY, c, 3) - cells.atFace(courantX, courantY, c, 2);
    content_[c] = volumeOf(cells, before, c) > 0 ? carried(cells.i(c), cells.j(c)) : 0.0f;
    excess_[c] = content_[c] - (netX + netY) - volumeOf(cells, after, c);
    const bool stays = volumeOf(cells, before, c) > 0 && volumeOf(cells, after, c) > 0;
    passed_[c] =
        stays &&
        ((match.apart() && !match.continues(regionOf(cells, before, c), regionOf(cells, after, c))) ||
         passedByWall(cells, c, before, after));
  }

  const auto gives = [&](int c) {
    return passed_[c] || (volumeOf(cells, before, c) > 0 && volumeOf(cells, after, c) <= 0);
  };
  orbits_.each(cells, cut, gives, [&](const Images& from, unsigned which) {
    handOverFrom(cells, from, which, match, before, after);
  });

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

// All that a cell and its images hold goes to cells that lack it, the nearest first, and to the nearest.
void TransferPlan::handOverFrom(const SmokeCells& cells, const Images& from, unsigned which,
                                const RegionMatch& match, const SmokeGeometry& before,
                                const SmokeGeometry& after) {
  std::array<int, 4> region;
  for (int g = 0; g < 4; ++g) region[g] = match.apart() ? regionOf(cells, before, from[g]) : -1;
  const auto takes = [&](int g, int other) {
    return volumeOf(cells, after, other) > 0 && !passed_[other] &&
           (region[g] < 0 || match.continues(region[g], regionOf(cells, after, other)));
  };
  Images nearest = {-1, -1, -1, -1}, found;
  const auto done = [&](int g) { return content_[from[g]] <= kTolerance && nearest[g] >= 0; };
  for (int reach : kReachOfPairs) {
    unsigned seeking = 0;
    for (int g = 0; g < 4; ++g) seeking |= static_cast<unsigned>(has(which, g) && !done(g)) << g;
    if (!seeking) break;
    start(cells, from, seeking, &before, reach);
    while (unsigned at = search_.next(found)) {
      for (int g = 0; g < 4; ++g) {
        if (!has(at, g)) continue;
        if (!takes(g, found[g]))
          at &= ~(1u << g);
        else if (nearest[g] < 0)
          nearest[g] = found[g];
      }
      Amounts moved = {};
      unsigned moving = 0;
      for (int g = 0; g < 4; ++g) {
        if (!has(at, g) || content_[from[g]] <= kTolerance) continue;
        moved[g] = shared(content_[from[g]], sharing(from, at, g), -excess_[found[g]], sharing(found, at, g));
        moving |= static_cast<unsigned>(moved[g] > kTolerance) << g;
      }
      if (moving) give(from, found, moved, moving);
      for (int g = 0; g < 4; ++g)
        if (has(at, g) && done(g)) search_.stop(g);
    }
  }
  // Then whatever lies between, if it is told apart what is on which side.
  for (const SmokeGeometry* through : {&before, static_cast<const SmokeGeometry*>(nullptr)}) {
    unsigned seeking = 0;
    for (int g = 0; g < 4; ++g)
      seeking |= static_cast<unsigned>(has(which, g) && nearest[g] < 0 && (through || region[g] >= 0)) << g;
    if (!seeking) continue;
    start(cells, from, seeking, through, kReachOfClosed);
    while (const unsigned at = search_.next(found))
      for (int g = 0; g < 4; ++g)
        if (has(at, g) && takes(g, found[g])) {
          nearest[g] = found[g];
          search_.stop(g);
        }
  }
  for (int g = 0; g < 4; ++g) {
    if (!has(which, g) || nearest[g] >= 0) continue;
    const int c = from[g], heir = region[g] < 0 ? -1 : match.heir(region[g]);
    if (passed_[c] && (region[g] < 0 || match.continues(region[g], regionOf(cells, after, c))))
      which &= ~(1u << g);
    else if (heir < 0)
      nearest[g] = nearestOpen(cells, after, c, -1, g);  // of a region that has vanished
  }
  giveRest(from, which, nearest);
}

// Notes a flow along the path that an image's search, which began at `from`, took to `to`.
void TransferPlan::route(const SmokeCells& cells, int image, int from, int to, float volume) {
  for (int cell = to; cell != from;) {
    const int face = search_.cameThrough(image, cell), last = search_.cellBefore(cells, image, cell);
    int i = cells.i(last) + (face == 1), j = cells.j(last) + (face == 3);
    if (cells.periodicX && i == cells.nx) i = 0;
    if (cells.periodicY && j == cells.ny) j = 0;
    flows_.push_back({face < 2, i, j, outwards(face) * volume});
    cell = last;
  }
}

// Adds the flows that are noted, those of one face at once: in the mirror image they may come in another
// order.
void TransferPlan::addFlows(const SmokeCells& cells, Field& courantX, Field& courantY) {
  std::sort(flows_.begin(), flows_.end(), [](const AddedFlow& a, const AddedFlow& b) {
    return a.x != b.x ? a.x : a.j != b.j ? a.j < b.j : a.i < b.i;
  });
  for (std::size_t k = 0; k < flows_.size();) {
    const AddedFlow& face = flows_[k];
    float& flow = face.x ? courantX(face.i, face.j) : courantY(face.i, face.j);
    double sum = flow;
    for (; k < flows_.size() && flows_[k].x == face.x && flows_[k].i == face.i && flows_[k].j == face.j; ++k)
      sum += flows_[k].volume;
    flow = static_cast<float>(sum);
    // The two copies of a periodic side's faces agree.
    if (cells.periodicX && face.x && face.i == 0) courantX(cells.nx, face.j) = flow;
    if (cells.periodicY && !face.x && face.j == 0) courantY(face.i, cells.ny) = flow;
  }
  flows_.clear();
}

// Lets open cells that would end with too much flow into the nearest that lack some, and cells that would end
// with less than half of their volume draw on others.
void TransferPlan::correctFlows(const SmokeCells& cells, const std::vector<int>& cut,
                                const SmokeGeometry& after, Field& courantX, Field& courantY) {
  const auto open = [&](int c) { return volumeOf(cells, after, c); };
  Images found;
  const auto routeAll = [&](const Images& from, const Amounts& moved, unsigned which, float sign) {
    Amounts volume;
    for (int g = 0; g < 4; ++g) {
      volume[g] = sign * moved[g];
      if (has(which, g)) route(cells, g, from[g], found[g], volume[g]);
    }
    addFlows(cells, courantX, courantY);
    shift(from, found, volume, which, excess_);
  };
  ++barrenNow_;
  for (const int reach : kReachOfFlows) {
    const auto wants = [&](int c) {
      return excess_[c] > kTolerance && open(c) > 0 && barren_[c] != barrenNow_;
    };
    orbits_.each(cells, cut, wants, [&](const Images& from, unsigned which) {
      start(cells, from, which, &after, reach);
      while (const unsigned at = search_.next(found)) {
        Amounts moved = {};
        unsigned moving = 0;
        for (int g = 0; g < 4; ++g) {
          if (!has(at, g)) continue;
          moved[g] =
              shared(excess_[from[g]], sharing(from, at, g), -excess_[found[g]], sharing(found, at, g));
          moving |= static_cast<unsigned>(moved[g] > kTolerance && open(found[g]) > 0) << g;
        }
        if (!moving) continue;
        routeAll(from, moved, moving, 1);
        for (int g = 0; g < 4; ++g)
          if (has(which, g) && excess_[from[g]] <= kTolerance) search_.stop(g);
      }
      // Where a wide search was in vain, the cells around need not try.
      for (int g = 0; g < 4; ++g) {
        if (!has(which, g) || excess_[from[g]] <= kTolerance || reach != kReachOfFlows[1]) continue;
        const std::vector<int>& seen = search_.queue(g);
        for (std::size_t k = 0; k < seen.size() / kBarrenPart; ++k) barren_[seen[k]] = barrenNow_;
      }
    });
  }
  const auto lacks = [&](int c) { return -0.5f * open(c) - excess_[c]; };
  const auto wants = [&](int c) { return excess_[c] < 0 && open(c) > 0 && lacks(c) > kTolerance; };
  orbits_.each(cells, cut, wants, [&](const Images& from, unsigned which) {
    start(cells, from, which, &after, kReachOfDeficit);
    while (const unsigned at = search_.next(found)) {
      Amounts moved = {};
      unsigned moving = 0;
      for (int g = 0; g < 4; ++g) {
        const float holds = has(at, g) ? open(found[g]) : 0;
        if (holds <= 0) continue;
        moved[g] = shared(lacks(from[g]), sharing(from, at, g), excess_[found[g]] + 0.5f * holds,
                          sharing(found, at, g));
        if (moved[g] <= kTolerance) continue;
        moving |= 1u << g;
        drawnOn_.push_back(found[g]);
      }
      if (!moving) continue;
      routeAll(from, moved, moving, -1);
      for (int g = 0; g < 4; ++g)
        if (has(which, g) && lacks(from[g]) <= kTolerance) search_.stop(g);
    }
  });
}

// Sends volumes along the paths that the images' searches, which began at `to`, took to `from`: each cell on
// the way passes on what it has, so that smoke moves by one cell rather than by the whole way.
void TransferPlan::send(const SmokeCells& cells, const Images& from, const Images& to, const Amounts& volume,
                        unsigned which) {
  const auto forPath = [&](int g, auto&& body) {
    for (int c = from[g]; c != to[g]; c = search_.cellBefore(cells, g, c)) body(c);
  };
  for (int g = 0; g < 4; ++g)
    if (has(which, g)) forPath(g, [&](int c) { ++drawing_[c]; });
  const std::size_t begin = exchanged_.size();
  for (int g = 0; g < 4; ++g) {
    if (!has(which, g)) continue;
    path_.clear();
    forPath(g, [&](int c) { path_.push_back(c); });
    int last = to[g];
    for (int k = static_cast<int>(path_.size()) - 1; k >= 0; --k) {
      const int c = path_[k];
      if (k > 0 && content_[c] < 1.5f * volume[g] * static_cast<float>(drawing_[c])) continue;
      exchanged_.push_back({c, last, std::min(1.0f, volume[g] / content_[c])});
      last = c;
    }
  }
  for (int g = 0; g < 4; ++g)
    if (has(which, g)) forPath(g, [&](int c) { drawing_[c] = 0; });
  if (which & (which - 1)) endGroup(exchanged_, begin);
  shift(from, to, volume, which, content_);
  shift(from, to, volume, which, excess_);
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
  Images found;
  // What each cell of an orbit lacks is sent to it from those that its search finds; most(c): of a cell.
  const auto draw = [&](const Images& to, unsigned which, int reach, auto&& lacks, auto&& most) {
    start(cells, to, which, &after, reach);
    while (const unsigned at = search_.next(found)) {
      Amounts moved = {};
      unsigned moving = 0;
      for (int g = 0; g < 4; ++g) {
        if (!has(at, g) || volumeOf(cells, after, found[g]) <= 0) continue;
        moved[g] = shared(lacks(to[g]), sharing(to, at, g), most(found[g]), sharing(found, at, g));
        moving |= static_cast<unsigned>(moved[g] > kTolerance) << g;
      }
      if (!moving) continue;
      send(cells, found, to, moved, moving);
      for (int g = 0; g < 4; ++g)
        if (has(which, g) && lacks(to[g]) <= kTolerance) search_.stop(g);
    }
  };
  const auto lacks = [&](int c) { return -excess_[c]; };
  for (int reach : kReachOfExchange)
    orbits_.each(
        cells, nodes, [&](int c) { return lacks(c) > kTolerance && volumeOf(cells, after, c) > 0; },
        [&](const Images& to, unsigned which) {
          draw(to, which, reach, lacks,
               [&](int other) { return std::min(excess_[other], kMostTaken * content_[other]); });
        });
  // A cell that carries less than half of what it holds draws on others.
  const auto lacksHalf = [&](int c) { return 0.5f * volumeOf(cells, after, c) - content_[c]; };
  orbits_.each(
      cells, nodes, [&](int c) { return lacksHalf(c) > kTolerance; },
      [&](const Images& to, unsigned which) {
        draw(to, which, kReachOfExchange[1], lacksHalf,
             [&](int other) { return content_[other] - 0.5f * volumeOf(cells, after, other); });
      });
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

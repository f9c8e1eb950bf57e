#include "fluid/smoke_spread.h"

#include <algorithm>
#include <cmath>

namespace smokebox {
namespace {
constexpr int kRounds = 16;        // an excess gets no farther than this many cells
constexpr std::int64_t kIdle = 4;  // quanta above the ceiling that are left where they are
constexpr std::int64_t kRounding =
    256;  // quanta that a cell may keep beyond what its value tells, 3e-5 of it
}  // namespace

int MassSpread::placeOf(int cell) {
  if (place_[cell] < 0) {
    place_[cell] = static_cast<int>(full_.size());
    full_.push_back({cell});
  }
  return place_[cell];
}

// Offers first, from what all have at the start of the round; then what is taken. Whether anything moved.
template <class Room>
bool MassSpread::oneRound(const SmokeCells& cells, const Boundary& b, Room&& room) {
  offers_.clear();
  const int count = static_cast<int>(full_.size());
  for (int k = 0; k < count; ++k) {
    const int cell = full_[k].cell;
    const Quanta excess = full_[k].excess;
    if (excess <= kIdle) continue;
    int next[4];
    Quanta rooms[4] = {}, sum = 0;
    int open = 0;
    for (int face = 0; face < 4; ++face) {
      next[face] = cells.atFace(b.openX, b.openY, cell, face) > 0 ? cells.neighbour(cell, face) : -1;
      if (next[face] < 0) continue;
      if (!(b.volume(cells.i(next[face]), cells.j(next[face])) > 0)) {
        next[face] = -1;
        continue;
      }
      ++open;
      sum += rooms[face] = room(next[face]);
    }
    const bool pass = sum == 0;
    if (open == 0 || (pass && excess <= kRounding)) continue;
    const Quanta wanted = std::min(excess, sum);
    for (int face = 0; face < 4; ++face) {
      if (next[face] < 0) continue;
      const Quanta amount = pass ? excess / open : wanted * rooms[face] / sum;
      if (amount == 0) continue;
      const int to = placeOf(next[face]);
      offers_.push_back({k, to, amount, pass});
      full_[to].room = rooms[face];
      if (!pass) full_[to].offered += amount;
    }
  }
  for (const Offer& o : offers_) {
    const Full& to = full_[o.to];
    full_[o.from].excess -= o.pass || to.offered <= to.room ? o.amount : o.amount * to.room / to.offered;
  }
  return !offers_.empty();
}

const std::vector<MassSpread::Overflow>& MassSpread::run(const SmokeCells& cells, const Boundary& b,
                                                         const Field& volume, float highest, Quantum q,
                                                         Field& mass, Field& value, Activity& active) {
  place_.resize(cells.count(), -1);
  full_.clear();
  overflow_.clear();
  auto quanta = [&](float m) { return static_cast<Quanta>(m * q.inverse); };
  auto holds = [&](int i, int j) {
    return static_cast<Quanta>(std::floor(highest * volume(i, j) * q.inverse));
  };
  auto room = [&](int cell) {
    const int i = cells.i(cell), j = cells.j(cell);
    return std::max<Quanta>(0, holds(i, j) - quanta(mass(i, j)));
  };
  for (int j = 0; j < cells.ny; ++j) {
    float *row = value.row(j), *m = mass.row(j);
    for (int first = 0; first < cells.nx; first += 16) {
      const int last = std::min(cells.nx, first + 16);
      bool any = false;
      for (int i = first; i < last; ++i) any |= row[i] > highest;
      if (!any) continue;
      for (int i = first; i < last; ++i) {
        if (!(row[i] > highest)) continue;
        row[i] = highest;
        const Quanta most = holds(i, j), excess = quanta(m[i]) - most;
        if (excess <= kIdle) continue;
        full_[placeOf(cells.cell(i, j))].excess = excess;
        m[i] = static_cast<float>(most) * q.size;
      }
    }
  }
  // The whole search is bounded: where a large region is over-full, looking for room is in vain.
  long budget = static_cast<long>(cells.count()) / 2 + 1000;
  for (int round = 0; round < kRounds && budget > 0; ++round) {
    budget -= 4 * static_cast<long>(full_.size());
    const bool moved = oneRound(cells, b, room);
    for (const Offer& o : offers_) {
      Full& to = full_[o.to];
      if (o.pass) {
        to.excess += o.amount;
        continue;
      }
      const Quanta taken = to.offered <= to.room ? o.amount : o.amount * to.room / to.offered;
      mass(cells.i(to.cell), cells.j(to.cell)) += static_cast<float>(taken) * q.size;
    }
    for (const Offer& o : offers_) full_[o.to].offered = 0;
    if (!moved) break;
  }
  for (const Full& f : full_) {
    const int i = cells.i(f.cell), j = cells.j(f.cell);
    place_[f.cell] = -1;
    if (f.excess > kRounding)
      overflow_.push_back({f.cell, static_cast<double>(f.excess) * q.size});
    else
      mass(i, j) += static_cast<float>(f.excess) * q.size;
    value(i, j) = std::min(highest, mass(i, j) / volume(i, j));
    active.at(i / Activity::kStrip, j) = 1;
  }
  return overflow_;
}

bool MassSpread::fill(const SmokeCells& cells, const Boundary& b, const Field& volume, Quantum q, Field& mass,
                      Field& value, Activity& active) {
  lacking_.clear();
  for (int j = 0; j < cells.ny; ++j) {
    const float* row = mass.row(j);
    float least = 0;
#pragma omp simd reduction(min : least)
    for (int i = 0; i < cells.nx; ++i) least = row[i] < least ? row[i] : least;
    if (!(least < 0)) continue;
    for (int i = 0; i < cells.nx; ++i)
      if (row[i] < 0) lacking_.push_back(cells.cell(i, j));
  }
  const auto massOf = [&](int c) -> float& { return mass(cells.i(c), cells.j(c)); };
  const auto quanta = [&](int c) { return static_cast<Quanta>(massOf(c) * q.inverse); };
  bool all = true;
  const auto draw = [&](const Images& to, unsigned which) {
    search_.start(cells, to, which, &b.openX, &b.openY, static_cast<int>(cells.count()));
    Images found;
    while (const unsigned at = search_.next(found)) {
      Quanta given[4] = {};
      for (int g = 0; g < 4; ++g) {
        if (!(at >> g & 1)) continue;
        // Of what two draw on each takes half, and of what two lack each brings half, be it one too much.
        const Quanta share = sharing(to, at, g), lacks = (share - 1 - quanta(to[g])) / share;
        given[g] = std::max<Quanta>(0, std::min(lacks, quanta(found[g]) / sharing(found, at, g)));
      }
      for (int g = 0; g < 4; ++g) {
        if (given[g] == 0) continue;
        const int x = cells.i(found[g]), y = cells.j(found[g]);
        massOf(to[g]) += static_cast<float>(given[g]) * q.size;
        mass(x, y) -= static_cast<float>(given[g]) * q.size;
        value(x, y) = volume(x, y) > 0 ? mass(x, y) / volume(x, y) : 0.0f;
        active.at(x / Activity::kStrip, y) = 1;
      }
      for (int g = 0; g < 4; ++g)
        if ((which >> g & 1) && massOf(to[g]) >= 0) search_.stop(g);
    }
    for (int g = 0; g < 4; ++g) {
      if (!(which >> g & 1)) continue;
      const int i = cells.i(to[g]), j = cells.j(to[g]);
      all &= mass(i, j) >= 0;
      value(i, j) = mass(i, j) < 0    ? value(i, j)
                    : mass(i, j) == 0 ? 0.0f
                                      : mass(i, j) / std::max(volume(i, j), 1e-6f);
    }
  };
  orbits_.each(
      cells, lacking_, [&](int c) { return massOf(c) < 0; }, draw);
  return all;
}

}  // namespace smokebox

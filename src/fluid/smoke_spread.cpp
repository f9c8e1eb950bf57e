#include "fluid/smoke_spread.h"

#include <algorithm>
#include <cmath>

namespace smokebox {
namespace {
constexpr int kReach = 60;        // cells looked at around one
constexpr float kIdle = 4;        // quanta above the ceiling that are left where they are
constexpr float kRounding = 256;  // quanta that a cell may keep beyond what its value tells, 3e-5 of it
}  // namespace

float MassSpread::run(const SmokeCells& cells, const Boundary& b, const Field& volume, float highest,
                      Quantum q, Field& mass, Field& value, Activity& active) {
  const std::size_t count = static_cast<std::size_t>(cells.nx) * cells.ny;
  seen_.resize(count, 0);
  // The whole search is bounded: where a large region is over-full, looking for room is in vain.
  long budget = static_cast<long>(count) / 2 + 1000;
  float most = highest;
  auto holds = [&](int i, int j) { return std::floor(highest * volume(i, j) * q.inverse) * q.size; };
  for (int j = 0; j < cells.ny; ++j) {
    const float* row = value.row(j);
    for (int first = 0; first < cells.nx; first += 16) {
      const int last = std::min(cells.nx, first + 16);
      bool any = false;
      for (int i = first; i < last; ++i) any |= row[i] > highest;
      if (!any) continue;
      for (int i = first; i < last; ++i) {
        if (!(row[i] > highest)) continue;
        float excess = mass(i, j) - holds(i, j);
        if (excess <= kIdle * q.size) {
          value(i, j) = highest;
          continue;
        }
        const float before = excess;
        const int from = cells.cell(i, j);
        queue_.assign(1, from);
        seen_[from] = ++search_;
        for (std::size_t head = 0;
             head < queue_.size() && excess > 0 && budget > 0 && queue_.size() <= kReach; ++head) {
          for (int face = 0; face < 4 && excess > 0; ++face) {
            --budget;
            if (!(cells.atFace(b.openX, b.openY, queue_[head], face) > 0)) continue;
            const int next = cells.neighbour(queue_[head], face);
            if (next < 0 || seen_[next] == search_) continue;
            seen_[next] = search_;
            queue_.push_back(next);
            const int x = cells.i(next), y = cells.j(next);
            const float moved = std::min(excess, holds(x, y) - mass(x, y));
            if (!(moved > 0)) continue;
            excess -= moved;
            mass(x, y) += moved;
            value(x, y) = std::min(highest, mass(x, y) / volume(x, y));
            active.at(x / Activity::kStrip, y) = 1;
          }
        }
        mass(i, j) -= before - excess;
        const float now = mass(i, j) / volume(i, j);
        value(i, j) = excess > kRounding * q.size ? now : std::min(highest, now);
        most = std::max(most, value(i, j));
      }
    }
  }
  return most;
}

bool MassSpread::fill(const SmokeCells& cells, const Boundary& b, const Field& volume, Field& mass,
                      Field& value, Activity& active) {
  seen_.resize(cells.count(), 0);
  bool all = true;
  for (int j = 0; j < cells.ny; ++j) {
    const float* row = mass.row(j);
    float least = 0;
#pragma omp simd reduction(min : least)
    for (int i = 0; i < cells.nx; ++i) least = row[i] < least ? row[i] : least;
    if (!(least < 0)) continue;
    for (int i = 0; i < cells.nx; ++i) {
      if (!(row[i] < 0)) continue;
      const int from = cells.cell(i, j);
      queue_.assign(1, from);
      seen_[from] = ++search_;
      for (std::size_t head = 0; head < queue_.size() && mass(i, j) < 0; ++head) {
        for (int face = 0; face < 4 && mass(i, j) < 0; ++face) {
          if (!(cells.atFace(b.openX, b.openY, queue_[head], face) > 0)) continue;
          const int next = cells.neighbour(queue_[head], face);
          if (next < 0 || seen_[next] == search_) continue;
          seen_[next] = search_;
          queue_.push_back(next);
          const int x = cells.i(next), y = cells.j(next);
          const float given = std::min(-mass(i, j), mass(x, y));
          if (!(given > 0)) continue;
          mass(i, j) += given;
          mass(x, y) -= given;
          value(x, y) = volume(x, y) > 0 ? mass(x, y) / volume(x, y) : 0.0f;
          active.at(x / Activity::kStrip, y) = 1;
        }
      }
      all &= mass(i, j) >= 0;
      value(i, j) = mass(i, j) < 0 ? value(i, j) : 0.0f;
    }
  }
  return all;
}

}  // namespace smokebox

#include "fluid/regions.h"

#include <algorithm>
#include <utility>

namespace smokebox {

using multigrid::kRegular;
using multigrid::Level;

double sumOfRow(const float* values, int begin, int end) {
  double part[8] = {};
  int i = begin;
  for (; i + 8 <= end; i += 8)
    for (int k = 0; k < 8; ++k) part[k] += static_cast<double>(values[i + k]);
  for (int k = 0; i < end; ++i, ++k) part[k] += static_cast<double>(values[i]);
  return ((part[0] + part[4]) + (part[2] + part[6])) + ((part[1] + part[5]) + (part[3] + part[7]));
}

int Regions::findRoot(int run) {
  while (root_[run] != run) run = root_[run] = root_[root_[run]];
  return run;
}

void Regions::join(int a, int b) {
  a = findRoot(a);
  b = findRoot(b);
  root_[std::max(a, b)] = std::min(a, b);
}

void Regions::rebuild(const Boundary& boundary, const Level& links) {
  const int nx = links.nx, ny = links.ny;
  runs_.clear();
  root_.clear();
  open_.clear();
  regions_.clear();
  rowBegin_.assign(ny + 1, 0);

  for (int j = 0; j < ny; ++j) {
    const int first = static_cast<int>(runs_.size());
    rowBegin_[j] = first;
    const float* ax = links.row(links.ax, j);
    const float* ay = links.row(links.ay, j);
    const float* ayAbove = ay + links.stride;
    const float* id = links.row(links.id, j);
    const std::uint8_t* kind = links.chunkRow(j);
    bool inside = false;
    const auto begin = [&](int i) {
      root_.push_back(static_cast<int>(runs_.size()));
      runs_.push_back({j, i, i, 0});
      open_.push_back(false);
      inside = true;
    };
    for (int c = 0; c < links.chunks; ++c) {
      const int start = c * kLanes, end = std::min(start + kLanes, nx);
      if (kind[c] & kRegular) {
        if (!inside) begin(start);
        runs_.back().end = end;
        continue;
      }
      for (int i = start; i < end; ++i) {
        if (id[i] == 0) {
          inside = false;
          continue;
        }
        if (!inside || !(ax[i] > 0)) begin(i);
        runs_.back().end = i + 1;
      }
    }
    const int last = static_cast<int>(runs_.size());
    if (first == last) continue;
    if (links.periodicX) {
      if (ax[0] > 0) join(first, last - 1);
    } else {
      if (ax[0] > 0) open_[first] = true;
      if (ax[nx] > 0) open_[last - 1] = true;
    }
    if (!links.periodicY && (j == 0 || j == ny - 1))
      for (int r = first; r < last; ++r)
        for (int i = runs_[r].begin; i < runs_[r].end && !open_[r]; ++i)
          if ((j == 0 && ay[i] > 0) || (j == ny - 1 && ayAbove[i] > 0)) open_[r] = true;
  }
  rowBegin_[ny] = static_cast<int>(runs_.size());

  const auto joinRows = [&](int lower, int upper, const float* face) {
    int a = rowBegin_[lower], b = rowBegin_[upper];
    while (a < rowBegin_[lower + 1] && b < rowBegin_[upper + 1]) {
      const int start = std::max(runs_[a].begin, runs_[b].begin), end = std::min(runs_[a].end, runs_[b].end);
      for (int i = start; i < end; ++i)
        if (face[i] > 0) {
          join(a, b);
          break;
        }
      ++(runs_[a].end < runs_[b].end ? a : b);
    }
  };
  for (int j = 1; j < ny; ++j) joinRows(j - 1, j, links.row(links.ay, j));
  if (links.periodicY) joinRows(ny - 1, 0, links.row(links.ay, 0));

  label_.assign(runs_.size(), -1);
  for (int r = 0; r < static_cast<int>(runs_.size()); ++r) {
    const int root = findRoot(r);
    if (label_[root] < 0) {
      label_[root] = static_cast<int>(regions_.size());
      regions_.emplace_back();
    }
    runs_[r].region = label_[root];
    Region& region = regions_[runs_[r].region];
    region.cells += runs_[r].end - runs_[r].begin;
    if (open_[r]) region.sealed = false;
  }
  anySealed_ = false;
  for (const Region& region : regions_) anySealed_ |= region.sealed;
  if (!anySealed_) return;
  for (const Run& run : runs_) {
    if (!regions_[run.region].sealed) continue;
    regions_[run.region].volume += sumOfRow(boundary.volume.row(run.j), run.begin, run.end);
  }
  for (Region& region : regions_) {
    region.unweighted = !(region.volume > 1e-3 * static_cast<double>(region.cells));
    if (region.unweighted) region.volume = static_cast<double>(region.cells);
  }
}

std::size_t Regions::bytes() const {
  return runs_.capacity() * sizeof(Run) + regions_.capacity() * sizeof(Region) +
         (root_.capacity() + label_.capacity() + rowBegin_.capacity()) * sizeof(int) + open_.capacity();
}

}  // namespace smokebox

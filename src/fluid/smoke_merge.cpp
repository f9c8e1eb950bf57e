#include "fluid/smoke_merge.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace smokebox {
namespace {
constexpr float kSmall = 0.25f;      // open share under which a cell is merged
constexpr float kMostOut = 0.95f;    // of a volume that may leave in one sweep
constexpr float kLeastLeft = 0.02f;  // of a volume that has to be there at the end of the step
constexpr int kMergeRounds = 4;
constexpr int kReduceRounds = 40;

// What flows through the outer faces of some cells.
struct Flow {
  float volume = 0, outX = 0, outY = 0, in = 0, netX = 0, netY = 0;

  float after() const { return volume - netX - netY; }
  // Into how many parts the step has to be cut; grows without limit as the volume vanishes.
  float parts() const {
    const float least = std::max(std::min(volume, after()), 1e-6f);
    return std::max(outX / kMostOut + std::max(netY, 0.0f), outY / kMostOut + std::max(netX, 0.0f)) / least;
  }
  bool empties() const { return after() < kLeastLeft * volume && outX + outY > 0; }
};
}  // namespace

std::size_t CellClusters::bytes() const {
  return (link_.capacity() + cluster_.capacity() + nodes_.capacity() + members_.capacity() +
          first_.capacity() + linked_.capacity()) *
             sizeof(int) +
         watched_.capacity() + (rootsX_.items.capacity() + rootsY_.items.capacity()) * sizeof(ClusterRoot);
}

int CellClusters::root(int cell) const {
  while (link_[cell] >= 0) cell = link_[cell];
  return cell;
}

void CellClusters::clear(const SmokeCells& cells) {
  for (int c : members_) cluster_[c] = -1;
  for (int c : linked_) link_[c] = -1;
  members_.clear();
  linked_.clear();
  first_.assign(1, 0);
  listRoots(cells);
}

// Links a cell (the root of its cluster, if it has one) to the neighbour behind its largest open face.
bool CellClusters::link(const SmokeCells& cells, const Boundary& boundary, const Field& start, int cell) {
  int best = -1;
  float bestOpen = 0, bestVolume = 0;
  for (int face = 0; face < 4; ++face) {
    const int next = cells.neighbour(cell, face);
    if (next < 0 || root(next) == cell) continue;
    const float open = cells.atFace(boundary.openX, boundary.openY, cell, face);
    const float volume = start(cells.i(next), cells.j(next));
    if (open > bestOpen || (open > 0 && open == bestOpen && volume > bestVolume)) {
      best = next;
      bestOpen = open;
      bestVolume = volume;
    }
  }
  if (best < 0) return false;
  link_[cell] = best;
  linked_.push_back(cell);
  return true;
}

// Lists the cells of each cluster, its root first.
void CellClusters::group() {
  for (int c : members_) cluster_[c] = -1;
  members_.clear();
  first_.assign(1, 0);
  // Roots first: number them in the order of the linked cells, count, then fill.
  int count = 0;
  for (int c : linked_) {
    const int r = root(c);
    if (cluster_[r] < 0) {
      cluster_[r] = count++;
      members_.push_back(r);
    }
  }
  for (int c : linked_) cluster_[c] = cluster_[root(c)];
  first_.assign(count + 1, 1);
  first_[count] = 0;
  for (int c : linked_) ++first_[cluster_[c]];
  int total = 0;
  for (int k = 0; k <= count; ++k) {
    const int size = k < count ? first_[k] : 0;
    first_[k] = total;
    total += size;
  }
  std::vector<int>& m = members_;
  m.resize(total);
  // Roots were listed in the order of their numbers: move each to the head of its cluster, from the last.
  for (int k = count - 1; k >= 0; --k) m[first_[k]] = m[k];
  placed_.assign(count, 0);
  for (int c : linked_) {
    const int k = cluster_[c];
    m[first_[k] + ++placed_[k]] = c;
  }
}

int CellClusters::build(const SmokeCells& cells, const std::vector<int>& cut, const std::vector<int>& nodes,
                        const Boundary& boundary, const Field& before, const Field& start, Field& courantX,
                        Field& courantY, int parts, int mostParts) {
  const std::size_t count = static_cast<std::size_t>(cells.nx) * cells.ny;
  if (link_.size() != count) {
    link_.assign(count, -1);
    cluster_.assign(count, -1);
  }
  clear(cells);
  watched_.resize(count, 0);
  for (int c : nodes_) watched_[c] = 0;
  nodes_ = nodes;
  for (int c : nodes_) watched_[c] = 1;
  auto volumeOf = [&](int c) { return start(cells.i(c), cells.j(c)); };
  for (int c : cut) {
    const int i = cells.i(c), j = cells.j(c);
    if (boundary.volume(i, j) > 0 && std::min({before(i, j), boundary.volume(i, j), start(i, j)}) < kSmall)
      link(cells, boundary, start, c);
  }
  group();

  auto flowOfCell = [&](int c, Flow& flow) {
    flow.volume += volumeOf(c);
    for (int face = 0; face < 4; ++face) {
      const int next = cells.neighbour(c, face);
      if (next >= 0 && cluster_[c] >= 0 && cluster_[next] == cluster_[c]) continue;
      const float out = outwards(face) * cells.atFace(courantX, courantY, c, face);
      (face < 2 ? flow.outX : flow.outY) += std::max(out, 0.0f);
      (face < 2 ? flow.netX : flow.netY) += out;
      flow.in += std::max(-out, 0.0f);
    }
  };
  auto flowOf = [&](int c) {  // c: a root or a cell by itself
    Flow flow;
    if (cluster_[c] < 0)
      flowOfCell(c, flow);
    else
      for (const int* m = begin(cluster_[c]); m != end(cluster_[c]); ++m) flowOfCell(*m, flow);
    return flow;
  };
  auto isNode = [&](int c) { return boundary.volume(cells.i(c), cells.j(c)) > 0 && link_[c] < 0; };

  for (int round = 0; round < kMergeRounds; ++round) {
    const std::size_t had = linked_.size();
    for (int c : cut) {
      if (!isNode(c)) continue;
      const Flow flow = flowOf(c);
      if (flow.parts() > parts || flow.empties()) link(cells, boundary, start, c);
    }
    if (linked_.size() == had) break;
    group();
  }

  // What still flows too fast.
  auto reduce = [&](int c, float factor) {
    auto cell = [&](int k) {
      for (int face = 0; face < 4; ++face) {
        const int next = cells.neighbour(k, face);
        if (next >= 0 && cluster_[k] >= 0 && cluster_[next] == cluster_[k]) continue;
        float& flow = cells.atFace(courantX, courantY, k, face);
        if (outwards(face) * flow <= 0) continue;
        flow *= factor;
        if (next >= 0 && !watched_[next]) {  // it gets less now
          watched_[next] = 1;
          nodes_.push_back(next);
        }
        // The two copies of a periodic side's faces agree.
        const int i = cells.i(k), j = cells.j(k);
        if (cells.periodicX && face < 2 && i + (face & 1) == (face & 1 ? cells.nx : 0))
          courantX(face & 1 ? 0 : cells.nx, j) = flow;
        if (cells.periodicY && face >= 2 && j + (face & 1) == (face & 1 ? cells.ny : 0))
          courantY(i, face & 1 ? 0 : cells.ny) = flow;
      }
    };
    if (cluster_[c] < 0)
      cell(c);
    else
      for (const int* m = begin(cluster_[c]); m != end(cluster_[c]); ++m) cell(*m);
  };
  auto tame = [&](int c) {
    const Flow flow = flowOf(c);
    const float out = flow.outX + flow.outY;
    if (out <= 0) return false;
    float factor = 1;
    if (flow.empties())
      factor = std::max(0.0f, (1 - 2 * kLeastLeft) * flow.volume + flow.in) / out;
    else if (flow.parts() > mostParts)
      factor = 0.9f * mostParts / flow.parts();
    if (factor >= 1) return false;
    reduce(c, flow.volume > 0 ? factor : 0.0f);
    return true;
  };
  bool changed = true;
  for (int round = 0; round < kReduceRounds && changed; ++round) {
    changed = false;
    for (std::size_t k = 0; k < nodes_.size(); ++k)
      if (isNode(nodes_[k])) changed |= tame(nodes_[k]);
    for (int k = 0; k < this->count(); ++k) changed |= tame(*begin(k));
  }
  listRoots(cells);
  if (changed) return 0;
  float most = static_cast<float>(parts);
  for (int c : nodes_)
    if (isNode(c)) most = std::max(most, flowOf(c).parts());
  for (int k = 0; k < this->count(); ++k) most = std::max(most, flowOf(*begin(k)).parts());
  return static_cast<int>(std::ceil(std::min(most, static_cast<float>(mostParts))));
}

void CellClusters::listRoots(const SmokeCells& cells) {
  // By rows: clusters are few, so a sort by key will do.
  auto fill = [&](RowList<ClusterRoot>& list, bool copiesX, bool copiesY) {
    std::vector<RootPlace>& places = places_;
    places.clear();
    for (int k = 0; k < count(); ++k) {
      const int i = cells.i(*begin(k)), j = cells.j(*begin(k));
      places.push_back({j, {i, k}});
      if (copiesX && i == 0) places.push_back({j, {cells.nx, k}});
      if (copiesX && i == cells.nx - 1) places.push_back({j, {-1, k}});
      if (copiesY && j == 0) places.push_back({cells.ny, {i, k}});
      if (copiesY && j == cells.ny - 1) places.push_back({-1, {i, k}});
    }
    std::sort(places.begin(), places.end(), [](const RootPlace& a, const RootPlace& b) {
      return a.j != b.j ? a.j < b.j : a.root.i < b.root.i;
    });
    list.items.clear();
    list.start.assign(cells.ny + 4, 0);
    for (const RootPlace& p : places) {
      list.items.push_back(p.root);
      ++list.start[p.j + 2];
    }
    for (int k = 1; k < cells.ny + 4; ++k) list.start[k] += list.start[k - 1];
  };
  fill(rootsX_, cells.periodicX, false);
  fill(rootsY_, false, cells.periodicY);
}

std::size_t IrregularFaces::bytes() const {
  return marksX_.capacity() + marksY_.capacity() +
         (x_.items.capacity() + y_.items.capacity()) * sizeof(IrregularFace);
}

namespace {
// Marks lie in rows -1 .. ny + 1 of columns -8 .. , eight to a word.
constexpr int kMarkMargin = 8;
constexpr std::uint8_t kSevenMeets = 1, kFiveMeets = 2;  // the stencil of that order meets what is not whole
int markStride(const SmokeCells& cells) { return (cells.nx + 2 * kMarkMargin + 7) / 8 * 8; }
}  // namespace

// Marks faces below .. above of the line along `axis`, counted from cell or face (i, j), and their periodic
// copies: those of the 5th-order stencil, and one more at either end, which only the 7th-order one reaches.
void IrregularFaces::mark(const SmokeCells& cells, Axis axis, int i, int j, int below, int above) {
  const int stride = markStride(cells);
  const bool alongX = axis == Axis::x, periodic = alongX ? cells.periodicX : cells.periodicY;
  const int n = alongX ? cells.nx : cells.ny, place = alongX ? i : j;
  const std::ptrdiff_t step = alongX ? 1 : stride;
  std::uint8_t* line =
      alongX ? marksX_.data() + (j + 1) * stride + kMarkMargin : marksY_.data() + stride + kMarkMargin + i;
  auto set = [&](int k, std::uint8_t mark) {
    if (k >= -1 && k <= n + 1) line[k * step] |= mark;
  };
  for (int k = place + below - 1; k <= place + above + 1; ++k) {
    const std::uint8_t reached = k < place + below || k > place + above ? kSevenMeets : kFiveMeets;
    set(k, reached);
    if (!periodic) continue;
    set(k + n, reached);
    set(k - n, reached);
  }
}

void IrregularFaces::collect(const SmokeCells& cells, Axis axis) {
  const int stride = markStride(cells);
  const std::vector<std::uint8_t>& marks = axis == Axis::x ? marksX_ : marksY_;
  RowList<IrregularFace>& list = axis == Axis::x ? x_ : y_;
  list.items.clear();
  list.start.assign(cells.ny + 4, 0);
  for (int j = -1; j <= cells.ny + 1; ++j) {
    list.start[j + 1] = static_cast<int>(list.items.size());
    const std::uint8_t* row = marks.data() + (j + 1) * stride;
    for (int word = 0; word < stride; word += 8) {
      std::uint64_t eight;
      std::memcpy(&eight, row + word, 8);
      if (!eight) continue;
      for (int k = word; k < word + 8; ++k)
        if (row[k]) list.items.push_back({k - kMarkMargin, j, row[k] == kSevenMeets});
    }
  }
  list.start[cells.ny + 3] = static_cast<int>(list.items.size());
}

void IrregularFaces::find(const SmokeCells& cells, const Boundary& b, const Field& before,
                          const Field& carried, std::vector<int>& cut) {
  cut.clear();
  const int nx = cells.nx, ny = cells.ny;
  const std::size_t size = static_cast<std::size_t>(markStride(cells)) * (ny + 3);
  marksX_.assign(size, 0);
  marksY_.assign(size, 0);
  for (int j = 0; j < ny; ++j) {
    const float *now = b.volume.row(j), *was = before.row(j), *has = carried.row(j);
    const float *x = b.openX.row(j), *y = b.openY.row(j), *above = b.openY.row(j + 1);
    const bool low = j > 0 || cells.periodicY, high = j < ny - 1 || cells.periodicY;
    // Closed cells among closed cells stay as they are, and what is marked for those around them is enough.
    auto deepInside = [&](int i) {
      if (now[i] > 0 || was[i] > 0 || i == 0 || j == 0 || i == nx - 1 || j == ny - 1) return false;
      const float *nowUp = b.volume.row(j + 1), *nowDown = b.volume.row(j - 1);
      const float *wasUp = before.row(j + 1), *wasDown = before.row(j - 1);
      return !(now[i - 1] > 0 || now[i + 1] > 0 || was[i - 1] > 0 || was[i + 1] > 0 || nowUp[i] > 0 ||
               nowDown[i] > 0 || wasUp[i] > 0 || wasDown[i] > 0);
    };
    for (int first = 0; first < nx; first += 16) {
      const int last = std::min(nx, first + 16);
      std::int32_t cutOff = 0;
#pragma omp simd reduction(| : cutOff)
      for (int i = first; i < last; ++i)
        cutOff |= (now[i] < 1) | (was[i] < 1) | (has[i] != 1) | (x[i] < 1) | (low & (y[i] < 1)) |
                  (high & (above[i] < 1));
      if (!cutOff && (x[last] >= 1 || (last == nx && !cells.periodicX))) continue;
      for (int i = first; i < last; ++i) {
        if (deepInside(i)) continue;
        const bool left = i > 0 || cells.periodicX, right = i < nx - 1 || cells.periodicX;
        // A full cell beside a face that a solid closes: the solid drives fluid through that face.
        const bool touched =
            (left && x[i] < 1) || (right && x[i + 1] < 1) || (low && y[i] < 1) || (high && above[i] < 1);
        if (now[i] < 1 || was[i] < 1 || has[i] != 1 || touched) cut.push_back(cells.cell(i, j));
        if (now[i] < 1 || was[i] < 1 || has[i] != 1) {
          mark(cells, Axis::x, i, j, -2, 3);
          mark(cells, Axis::y, i, j, -2, 3);
        }
        if (x[i] < 1 && left) mark(cells, Axis::x, i, j, -2, 2);
        if (y[i] < 1 && low) mark(cells, Axis::y, i, j, -2, 2);
      }
    }
  }
  collect(cells, Axis::x);
  collect(cells, Axis::y);
}

void IrregularFaces::choose(const SmokeCells& cells, const Boundary& b, const CellClusters& clusters) {
  auto wrap = [](int k, int n, bool periodic) { return periodic ? (k + n) % n : std::clamp(k, 0, n - 1); };
  auto usable = [&](int i, int j) { return b.volume(i, j) > 0 && !clusters.merged(cells.cell(i, j)); };
  for (IrregularFace& f : x_.items) {
    auto cell = [&](int i) { return usable(wrap(i, cells.nx, cells.periodicX), f.j); };
    auto open = [&](int i) {
      return cells.periodicX ? b.openX((i + cells.nx) % cells.nx, f.j) >= 0.5f
                             : i > 0 && i < cells.nx && b.openX(i, f.j) >= 0.5f;
    };
    f.donor = !(cell(f.i - 1) && cell(f.i));
    f.behindLow = open(f.i - 1) && cell(f.i - 2);
    f.behindHigh = open(f.i + 1) && cell(f.i + 1);
  }
  for (IrregularFace& f : y_.items) {
    auto cell = [&](int j) { return usable(f.i, wrap(j, cells.ny, cells.periodicY)); };
    auto open = [&](int j) {
      return cells.periodicY ? b.openY(f.i, (j + cells.ny) % cells.ny) >= 0.5f
                             : j > 0 && j < cells.ny && b.openY(f.i, j) >= 0.5f;
    };
    f.donor = !(cell(f.j - 1) && cell(f.j));
    f.behindLow = open(f.j - 1) && cell(f.j - 2);
    f.behindHigh = open(f.j + 1) && cell(f.j + 1);
  }
}

}  // namespace smokebox

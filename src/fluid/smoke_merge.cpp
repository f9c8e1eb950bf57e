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

// What flows through the outer faces of some cells. In float64, where the order of the cells, which is not
// the mirror image's, is all one.
struct Flow {
  double volume = 0, outX = 0, outY = 0, in = 0, netX = 0, netY = 0;

  double after() const { return volume - netX - netY; }
  // Into how many parts the step has to be cut; grows without limit as the volume vanishes.
  float parts() const {
    const double least = std::max(std::min(volume, after()), 1e-6);
    return static_cast<float>(
        std::max(outX / kMostOut + std::max(netY, 0.0), outY / kMostOut + std::max(netX, 0.0)) / least);
  }
  bool empties() const { return after() < kLeastLeft * volume && outX + outY > 0; }
};
}  // namespace

std::size_t CellClusters::bytes() const {
  return orbits_.bytes() +
         (link_.capacity() + cluster_.capacity() + nodes_.capacity() + members_.capacity() +
          first_.capacity() + linked_.capacity() + roots_.capacity()) *
             sizeof(int) +
         watched_.capacity() + (rootsX_.items.capacity() + rootsY_.items.capacity()) * sizeof(ClusterRoot);
}

int CellClusters::root(int cell) const {
  while (link_[cell] >= 0) cell = link_[cell];
  return cell;
}

void CellClusters::clear(const SmokeCells& cells) {
  for (int c : members_) {
    cluster_[c] = -1;
    link_[c] = kNone;
  }
  members_.clear();
  linked_.clear();
  first_.assign(1, 0);
  listRoots(cells);
}

// The neighbour behind the largest open face of a cell (the root of its cluster, if it has one) that is none
// of its own cluster, nor of those of the cells `but`; of two that are alike the one that its image would
// choose there. -1: none.
int CellClusters::partner(const SmokeCells& cells, const Boundary& boundary, const Field& start, int cell,
                          int image, const Images& but) const {
  int best = -1;
  float bestOpen = 0, bestVolume = 0;
  for (int k = 0; k < 4; ++k) {
    const int face = imageOfFace(k, image), next = cells.neighbour(cell, face);
    if (next < 0) continue;
    const int to = root(next);
    if (to == cell || std::find(but.begin(), but.end(), to) != but.end()) continue;
    const float open = cells.atFace(boundary.openX, boundary.openY, cell, face);
    const float volume = start(cells.i(next), cells.j(next));
    if (open > bestOpen || (open > 0 && open == bestOpen && volume > bestVolume)) {
      best = next;
      bestOpen = open;
      bestVolume = volume;
    }
  }
  return best;
}

void CellClusters::join(int cell, int other) {
  if (root(other) == cell) return;
  link_[cell] = other;
  linked_.push_back(cell);
}

// Links cells, images of each other and each the root of its cluster, to their partners. They do not link to
// each other, unless there is nothing else: then, and where a cell on an axis has a partner on either side,
// the root is one of those merged.
void CellClusters::link(const SmokeCells& cells, const Boundary& boundary, const Field& start,
                        const Images& images, unsigned which) {
  Images roots = {-1, -1, -1, -1}, best = {-1, -1, -1, -1};
  for (int g = 0; g < 4; ++g)
    if ((which >> g & 1) && link_[images[g]] == kNone) roots[g] = images[g];
  bool apart[4] = {};
  for (int g = 0; g < 4; ++g) {
    if (roots[g] < 0) continue;
    best[g] = partner(cells, boundary, start, images[g], g, {-1, -1, -1, -1});
    if (best[g] < 0 || std::find(roots.begin(), roots.end(), root(best[g])) == roots.end()) continue;
    const int other = partner(cells, boundary, start, images[g], g, roots);
    if (other >= 0)
      best[g] = other;
    else
      apart[g] = true;
  }
  for (int g = 0; g < 4; ++g) {
    if (best[g] < 0) continue;
    const int c = images[g];
    if (link_[c] == kNone) {
      join(c, best[g]);
      if (apart[g] && link_[root(c)] == kNone) link_[root(c)] = kMerged;
    } else if (root(best[g]) != root(c)) {  // on an axis, and linked to the other side
      const int far = root(best[g]), near = root(c);
      link_[near] = kMerged;
      link_[far] = c;
      linked_.push_back(far);
    }
  }
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
    link_.assign(count, kNone);
    cluster_.assign(count, -1);
  }
  clear(cells);
  watched_.resize(count, 0);
  for (int c : nodes_) watched_[c] = 0;
  nodes_ = nodes;
  for (int c : nodes_) watched_[c] = 1;
  auto volumeOf = [&](int c) { return start(cells.i(c), cells.j(c)); };
  const auto small = [&](int c) {
    const int i = cells.i(c), j = cells.j(c);
    return boundary.volume(i, j) > 0 && std::min({before(i, j), boundary.volume(i, j), start(i, j)}) < kSmall;
  };
  const auto linkAll = [&](const Images& images, unsigned which) {
    link(cells, boundary, start, images, which);
  };
  orbits_.each(cells, cut, small, linkAll);
  group();

  auto flowOfCell = [&](int c, Flow& flow) {
    flow.volume += volumeOf(c);
    for (int face = 0; face < 4; ++face) {
      const int next = cells.neighbour(c, face);
      if (next >= 0 && cluster_[c] >= 0 && cluster_[next] == cluster_[c]) continue;
      const double out = outwards(face) * cells.atFace(courantX, courantY, c, face);
      (face < 2 ? flow.outX : flow.outY) += std::max(out, 0.0);
      (face < 2 ? flow.netX : flow.netY) += out;
      flow.in += std::max(-out, 0.0);
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
    const auto overdrawn = [&](int c) {
      if (!isNode(c) || link_[c] == kMerged) return false;
      const Flow flow = flowOf(c);
      return flow.parts() > parts || flow.empties();
    };
    orbits_.each(cells, cut, overdrawn, linkAll);
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
  auto factorOf = [&](int c) {
    const Flow flow = flowOf(c);
    const double out = flow.outX + flow.outY;
    double factor = 1;
    if (out <= 0) return 1.0f;
    if (flow.empties())
      factor = std::max(0.0, (1 - 2 * kLeastLeft) * flow.volume + flow.in) / out;
    else if (flow.parts() > mostParts)
      factor = 0.9f * mostParts / flow.parts();
    return factor >= 1 ? 1.0f : flow.volume > 0 ? static_cast<float>(factor) : 0.0f;
  };
  bool changed = true;
  for (int round = 0; round < kReduceRounds && changed; ++round) {
    changed = false;
    const auto tame = [&](const Images& images, unsigned which) {
      Images unit = {-1, -1, -1, -1};  // each image's cluster, or itself
      float factor[4] = {1, 1, 1, 1};
      for (int g = 0; g < 4; ++g) {
        if (!(which >> g & 1)) continue;
        const int k = cluster_[images[g]], own = k < 0 ? images[g] : *begin(k);
        if (std::find(unit.begin(), unit.end(), own) != unit.end()) continue;
        unit[g] = own;
        factor[g] = factorOf(own);
      }
      for (int g = 0; g < 4; ++g)
        if (factor[g] < 1) reduce(unit[g], factor[g]), changed = true;
    };
    orbits_.each(cells, nodes_, isNode, tame);
    roots_.clear();
    for (int k = 0; k < this->count(); ++k) roots_.push_back(*begin(k));
    orbits_.each(
        cells, roots_, [&](int c) { return cluster_[c] >= 0; }, tame);
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

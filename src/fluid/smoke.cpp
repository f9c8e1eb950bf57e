#include "fluid/smoke.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "fluid/mirror_search.h"
#include "fluid/smoke_spread.h"
#include "fluid/smoke_volumes.h"
#include "fluid/sweep.h"

namespace smokebox {
namespace {

constexpr int kGrain = 32;
constexpr float kSliver = 0.25f;
constexpr float kLargest = 1e30f;
constexpr float kLeastCarried = 0.02f;
constexpr double kFewQuanta = 8;  // that roundings make of a value
// The share of what the bound is above the largest value that a step leaves: a crest between two cells may
// rise again.
constexpr float kBoundKept = 0.99f;

// The smallest power of two q with value <= 2^23 q: twice as much still fits into the exact range of float32.
float quantumFor(float value) {
  int exponent = 0;
  const float mantissa = std::frexp(value, &exponent);
  return std::ldexp(1.0f, std::max(mantissa == 0.5f ? exponent - 1 : exponent, -60) - 23);
}

struct Channel {
  Field mass, value;
  Quantum quantum;
  float highest = 0;   // bound of the values: the largest of late, or when smoke was put aside that still is
  float swept = 0;     // the same after the sweeps
  float kept = 0;      // that of when smoke was put aside
  double ceiling = 0;  // no less than the largest value, without the rounding of many additions
  Activity active;
  long added = 0;                             // how often smoke was added
  double emitted = 0, left = 0, rounded = 0;  // in cell areas; rounded: taken by rounding to coarser quanta
};

// Smoke of a cell that closed with no open cell of its region in reach, or that neither a cell nor those
// around it can hold.
struct Trapped {
  int channel, cell;
  double mass;
  int region;                           // in which a cell is looked for; -1: in any; or:
  static constexpr int kVanished = -2;  // its region is gone: it waits for the cell itself to open
};

}  // namespace

struct Smoke::Impl {
  ThreadPool& pool;
  SmokeVolumes volumes;
  Sweeper sweeper;
  MassSpread spread;
  std::vector<Channel> channels;
  Field massOut, valueOut;
  Activity activeOut, anyActive;
  std::vector<Trapped> trapped;
  std::vector<float> clusterMass, clusterVolume;
  std::vector<float> amounts;  // scratch
  double cellArea;
  bool yFirst = false;

  Impl(const Boundary& b, ThreadPool& threads, int count)
      : pool(threads),
        volumes(b),
        sweeper(b.grid.nx, b.grid.ny),
        channels(count),
        massOut(b.grid.nx, b.grid.ny),
        valueOut(b.grid.nx, b.grid.ny),
        activeOut(b.grid.nx, b.grid.ny),
        anyActive(b.grid.nx, b.grid.ny),
        cellArea(b.grid.h * b.grid.h) {
    for (Channel& c : channels) {
      c.mass = Field(b.grid.nx, b.grid.ny);
      c.value = Field(b.grid.nx, b.grid.ny);
      c.active = Activity(b.grid.nx, b.grid.ny);
    }
  }

  struct Extent {
    int left, right, bottom, top;
  };
  static Extent extentOf(const Field& share);
  void setQuantum(Channel& c, float q) { c.quantum = {q, 1 / q}; }
  void makeRoom(int channel, float highest);
  void move(int channel, const std::vector<SmokeTransfer>& transfers);
  void renew(Channel& c, int cell, const Field& volume, float highest);
  void release(int channel, const Boundary& b, float highest);
  void keepBelow(int channel, const Boundary& b, float highest);
  void shareValues(Channel& c, const SweptVolumes& volume);
  void donorClusters(const Channel& c, Axis axis, const SweptVolumes& volume);
  void fillMargins(Channel& c, Axis axis);
  void endClusters(Channel& c, const Boundary& b);
  void sweep(int channel, Axis axis, const SweptVolumes& volume, const Field* divisor);
  void end(int channel, const Boundary& b);
  void touch(Channel& c, int cell) {
    c.active.at(volumes.cells().i(cell) / Activity::kStrip, volumes.cells().j(cell)) = 1;
  }
  void wrapActivity(Channel& c) {
    if (!volumes.cells().periodicY) return;
    const int ny = volumes.cells().ny;
    for (int s = 0; s < c.active.strips(); ++s)
      for (int k = 1; k <= 4; ++k) {
        c.active.at(s, -k) = c.active.at(s, ny - k);
        c.active.at(s, ny - 1 + k) = c.active.at(s, k - 1);
      }
  }
};

// Coarsens the quantum if values up to `highest` need it. Each cell is rounded by itself, half to even: so
// that mirror images stay such, and nothing is made or lost on average. What rounding took in all, some parts
// in 1e10 of it, is kept and counted.
void Smoke::Impl::makeRoom(int channel, float highest) {
  Channel& c = channels[channel];
  if (highest <= 0) return;
  const float needed = quantumFor(highest);
  if (c.quantum.size == 0 || (c.quantum.size >= 4 * needed && c.highest > 0)) setQuantum(c, needed);
  if (needed <= c.quantum.size) return;
  setQuantum(c, needed);
  const int nx = volumes.cells().nx;
  c.rounded += pool.sum(0, volumes.cells().ny, kGrain, [&](int begin, int end) {
    double sum = 0;
    for (int j = begin; j < end; ++j) {
      float* m = c.mass.row(j);
      for (int i = 0; i < nx; ++i) {
        const float whole = std::nearbyint(m[i] * c.quantum.inverse) * c.quantum.size;
        sum += static_cast<double>(m[i]) - whole;
        m[i] = whole;
      }
    }
    return sum;
  });
}

// What goes from cell to cell. Amounts of a group are found before any of them moves. Where several leave a
// cell nothing, what does not divide by them is rounded half to even.
void Smoke::Impl::move(int channel, const std::vector<SmokeTransfer>& transfers) {
  Channel& c = channels[channel];
  const SmokeCells& cells = volumes.cells();
  const Quantum q = c.quantum;
  const auto amount = [&](const SmokeTransfer& t) {
    const float from = c.mass(cells.i(t.from), cells.j(t.from));
    if (!(from > 0)) return 0.0f;
    const auto drawing = static_cast<float>(t.drawing);
    if (t.all) return t.drawing == 1 ? from : std::nearbyint(from / drawing * q.inverse) * q.size;
    const float most = t.drawing == 1 ? from : std::floor(from / drawing * q.inverse) * q.size;
    if (t.share >= 1) return most;
    return std::min(most, std::floor(from * t.share * q.inverse + 0.5f) * q.size);
  };
  for (std::size_t begin = 0, end = 0; begin < transfers.size(); begin = end) {
    amounts.clear();
    do amounts.push_back(amount(transfers[end]));
    while (transfers[end++].grouped);
    for (std::size_t k = begin; k < end; ++k) {
      const SmokeTransfer& t = transfers[k];
      const float m = amounts[k - begin];
      if (!(m > 0)) continue;
      c.mass(cells.i(t.from), cells.j(t.from)) -= m;
      if (t.to < 0) {
        const int region = volumes.regionsBefore().at(cells.i(t.from), cells.j(t.from));
        trapped.push_back({channel, t.from, m, volumes.match().apart() ? volumes.match().heir(region) : -1});
        continue;
      }
      c.mass(cells.i(t.to), cells.j(t.to)) += m;
      touch(c, t.to);
    }
    for (std::size_t k = begin; k < end; ++k) {
      const SmokeTransfer& t = transfers[k];
      if (!t.all || t.drawing == 1) continue;
      float& rest = c.mass(cells.i(t.from), cells.j(t.from));
      c.rounded += rest;
      rest = 0;
    }
  }
}

// Gives back what was kept aside: to the cell, or where that has closed to one that is open near by (on an
// axis to those that its images find), up to twice what it holds at the ceiling. What is too much there is
// spread, or kept aside again.
void Smoke::Impl::release(int channel, const Boundary& b, float highest) {
  const SmokeCells& cells = volumes.cells();
  Channel& c = channels[channel];
  const Quantum q = c.quantum;
  if (q.size == 0) return;
  for (Trapped& t : trapped) {
    if (t.channel != channel) continue;
    const bool open = b.volume(cells.i(t.cell), cells.j(t.cell)) > 0;
    if (!open && (!volumes.moved() || t.region == Trapped::kVanished)) continue;
    const int fromRight = 2 * cells.i(t.cell) + 1 - cells.nx, fromTop = 2 * cells.j(t.cell) + 1 - cells.ny;
    Images to = {-1, -1, -1, -1};
    int count = 0;
    for (int g = 0; g < 4; ++g) {
      if ((g & 1 ? fromRight < 0 : fromRight > 0) || (g & 2 ? fromTop < 0 : fromTop > 0)) continue;
      const int found = open && t.region < 0
                            ? t.cell
                            : volumes.plan().nearestOpen(cells, {&b.openX, &b.openY, &b.volume, &b.regions},
                                                         t.cell, t.region, g);
      if (found >= 0 && std::find(to.begin(), to.end(), found) == to.end()) to[count++] = found;
    }
    const double share = t.mass / std::max(count, 1);
    for (int k = 0; k < count; ++k) {
      const int i = cells.i(to[k]), j = cells.j(to[k]);
      const double room = 2.0 * highest * volumes.carried()(i, j) - c.mass(i, j);
      const double moved = std::floor(std::min(share, std::max(room, 0.0)) * q.inverse) * q.size;
      t.mass -= moved;
      if (!(moved > 0)) continue;
      c.mass(i, j) += static_cast<float>(moved);
      renew(c, to[k], volumes.carried(), kLargest);
      c.highest = std::max(c.highest, c.value(i, j));
      touch(c, to[k]);
    }
    if (count > 0 && t.mass < count * q.size) {
      c.rounded += t.mass;
      t.mass = 0;
    }
  }
  std::erase_if(trapped, [](const Trapped& t) { return t.mass == 0; });
}

// The columns and rows in which a share is not 0.
Smoke::Impl::Extent Smoke::Impl::extentOf(const Field& share) {
  Extent e{share.nx(), 0, share.ny(), 0};
  for (int j = 0; j < share.ny(); ++j) {
    const float* row = share.row(j);
    std::int32_t any = 0;
#pragma omp simd reduction(| : any)
    for (int i = 0; i < share.nx(); ++i) any |= row[i] > 0 ? 1 : 0;
    if (!any) continue;
    e.bottom = std::min(e.bottom, j);
    e.top = j + 1;
    int left = 0, right = share.nx();
    while (!(row[left] > 0)) ++left;
    while (!(row[right - 1] > 0)) --right;
    e.left = std::min(e.left, left);
    e.right = std::max(e.right, right);
  }
  return e;
}

// The value of a cell from its mass; `highest` is passed by rounding only.
void Smoke::Impl::renew(Channel& c, int cell, const Field& volume, float highest) {
  const int i = volumes.cells().i(cell), j = volumes.cells().j(cell);
  // In a sliver the quotient is all rounding: it keeps the value of its neighbourhood.
  if (volume(i, j) < kLeastCarried && c.mass(i, j) > 0 && c.value(i, j) > 0) return;
  c.value(i, j) = c.mass(i, j) > 0 ? std::min(c.mass(i, j) / std::max(volume(i, j), 1e-6f), highest) : 0.0f;
}

// Values of the cells that are not full, from mass and volume; one for each cluster.
void Smoke::Impl::shareValues(Channel& c, const SweptVolumes& volume) {
  const SmokeCells& cells = volumes.cells();
  const CellClusters& clusters = volumes.clusters();
  for (int k = 0; k < clusters.count(); ++k) {
    double m = 0, v = 0;
    for (const int* cell = clusters.begin(k); cell != clusters.end(k); ++cell) {
      m += c.mass(cells.i(*cell), cells.j(*cell));
      v += volume.at(cells.i(*cell), cells.j(*cell));
    }
    const float value = m > 0 ? static_cast<float>(m / std::max(v, 1e-6)) : 0.0f;
    for (const int* cell = clusters.begin(k); cell != clusters.end(k); ++cell) {
      c.value(cells.i(*cell), cells.j(*cell)) = value;
      if (m > 0) touch(c, *cell);
    }
  }
}

// Mass and volume of each cluster after the donor fluxes of one sweep.
void Smoke::Impl::donorClusters(const Channel& c, Axis axis, const SweptVolumes& volume) {
  const SmokeCells& cells = volumes.cells();
  const CellClusters& clusters = volumes.clusters();
  const Field& courant = volumes.courant(axis);
  const int di = axis == Axis::x, dj = 1 - di;
  clusterMass.resize(clusters.count());
  clusterVolume.resize(clusters.count());
  for (int k = 0; k < clusters.count(); ++k) {
    double m = 0, v = 0;
    for (const int* cell = clusters.begin(k); cell != clusters.end(k); ++cell) {
      const int i = cells.i(*cell), j = cells.j(*cell);
      const float low = courant(i, j), high = courant(i + di, j + dj);
      const bool clean =
          (axis == Axis::x ? i == 0 && !cells.periodicX : j == 0 && !cells.periodicY) && low > 0;
      const bool cleanHigh =
          (axis == Axis::x ? i == cells.nx - 1 && !cells.periodicX : j == cells.ny - 1 && !cells.periodicY) &&
          high < 0;
      const float in = clean ? 0.0f : low * (low > 0 ? c.value(i - di, j - dj) : c.value(i, j));
      const float out = cleanHigh ? 0.0f : high * (high > 0 ? c.value(i, j) : c.value(i + di, j + dj));
      m += static_cast<double>(c.mass(i, j)) - (static_cast<double>(out) - in);
      v += volume.at(i, j) - (high - low);
    }
    clusterMass[k] = static_cast<float>(m);
    clusterVolume[k] = static_cast<float>(v);
  }
}

void Smoke::Impl::fillMargins(Channel& c, Axis axis) {
  const SmokeCells& cells = volumes.cells();
  const int nx = cells.nx, ny = cells.ny;
  const Field& courant = volumes.courant(axis);
  if (axis == Axis::x ? cells.periodicX : cells.periodicY) {
    wrapMargin(c.mass, axis, nx, ny);
    wrapMargin(c.value, axis, nx, ny);
    return;
  }
  // Walls and outflows continue the last value, inflows bring clean air.
  if (axis == Axis::x) {
    for (int j = 0; j < ny; ++j) {
      float* r = c.value.row(j);
      const float low = courant(0, j) > 0 ? 0.0f : r[0], high = courant(nx, j) < 0 ? 0.0f : r[nx - 1];
      for (int k = 1; k <= 4; ++k) {
        r[-k] = low;
        r[nx - 1 + k] = high;
      }
    }
  } else {
    for (int k = 1; k <= 4; ++k) {
      const float *first = c.value.row(0), *last = c.value.row(ny - 1);
      const float *low = courant.row(0), *high = courant.row(ny);
      float *below = c.value.row(-k), *above = c.value.row(ny - 1 + k);
      for (int i = 0; i < nx; ++i) {
        below[i] = low[i] > 0 ? 0.0f : first[i];
        above[i] = high[i] < 0 ? 0.0f : last[i];
      }
    }
  }
}

// Shares the mass of each cluster out among its cells by their open area, as its volume has been. What
// rounding leaves goes to the largest; where that has images in the cluster, they share it, half to even.
void Smoke::Impl::endClusters(Channel& c, const Boundary& b) {
  const SmokeCells& cells = volumes.cells();
  const CellClusters& clusters = volumes.clusters();
  const Quantum q = c.quantum;
  for (int k = 0; k < clusters.count(); ++k) {
    double m = 0, v = 0;
    int largest = *clusters.begin(k);
    for (const int* cell = clusters.begin(k); cell != clusters.end(k); ++cell) {
      const int i = cells.i(*cell), j = cells.j(*cell);
      m += c.mass(i, j);
      v += b.volume(i, j);
      if (b.volume(i, j) > b.volume(cells.i(largest), cells.j(largest))) largest = *cell;
    }
    const double value = m / std::max(volumes.clusterCarried(k), 1e-6);
    const Images images = imagesOf(cells, largest);
    unsigned sharers = 1;  // bits of images that are other cells, as large
    double rest = m;
    for (const int* cell = clusters.begin(k); cell != clusters.end(k); ++cell) {
      const int i = cells.i(*cell), j = cells.j(*cell);
      const double part = std::floor(m * (b.volume(i, j) / v) * q.inverse) * q.size;
      rest -= part;
      c.mass(i, j) = static_cast<float>(part);
      c.value(i, j) = static_cast<float>(value);
      if (m > 0) touch(c, *cell);
      for (int g = 1; g < 4; ++g)
        if (images[g] == *cell && sharing(images, sharers, g) == 0 &&
            b.volume(i, j) == b.volume(cells.i(largest), cells.j(largest)))
          sharers |= 1u << g;
    }
    const int count = std::popcount(sharers);
    const double each = count == 1 ? rest : std::nearbyint(rest / count * q.inverse) * q.size;
    for (int g = 0; g < 4; ++g)
      if (sharers >> g & 1) c.mass(cells.i(images[g]), cells.j(images[g])) += static_cast<float>(each);
    c.rounded += rest - count * each;
    c.highest = std::max(c.highest, static_cast<float>(value));
  }
}

Smoke::Smoke(const Boundary& boundary, ThreadPool& pool, int channels)
    : impl_(std::make_unique<Impl>(boundary, pool, channels)) {}

Smoke::~Smoke() = default;

int Smoke::channels() const { return static_cast<int>(impl_->channels.size()); }

const Field& Smoke::value(int channel) const { return impl_->channels[channel].value; }

void Smoke::add(const Boundary& boundary, int channel, const Field& share, double amount) {
  Impl& s = *impl_;
  Channel& c = s.channels[channel];
  if (amount == 0) return;
  s.makeRoom(channel, static_cast<float>(c.highest + std::max(amount, 0.0)));
  if (c.quantum.size == 0) return;  // nothing there to be taken away
  const double inverse = c.quantum.inverse, size = c.quantum.size;
  // What is added is cut to whole quanta at a height that changes from step to step (by the golden ratio,
  // from the middle), so that what a source gives in many steps is not off by as many roundings.
  const double height = 0.5 + 0.6180339887498949 * static_cast<double>(c.added++ % (1 << 20));
  const double upwards = height - std::floor(height);
  // No value grows by more than `amount`, whatever is rounded.
  if (c.highest < c.ceiling - kFewQuanta * size) c.ceiling = c.highest;
  c.ceiling += std::max(amount, 0.0);
  const float nearest = static_cast<float>(c.ceiling);
  const float limit = nearest > c.ceiling ? std::nextafter(nearest, 0.0f) : nearest;
  double added = 0;
  const Impl::Extent extent = s.extentOf(share);
  for (int j = extent.bottom; j < extent.top; ++j) {
    const float *part = share.row(j), *carried = s.volumes.carried().row(j);
    const float *was = s.volumes.openShare().row(j), *open = boundary.volume.row(j);
    float *m = c.mass.row(j), *value = c.value.row(j);
    for (int i = extent.left; i < extent.right; ++i) {
      if (!(part[i] > 0) || !(open[i] > 0) || !(was[i] > 0)) continue;
      const double wanted = amount * part[i] * carried[i] * inverse;
      double more = std::floor(wanted + (carried[i] < kSliver ? 0 : upwards)) * size;
      if (m[i] + more < 0) more = -m[i];
      m[i] = static_cast<float>(m[i] + more);
      added += more;
      // Where the value was at the ceiling, a little less than mass over volume, it stays so.
      const float grown = value[i] + static_cast<float>(more / carried[i]), quotient = m[i] / carried[i];
      value[i] = std::min(more > 0 && grown < quotient ? grown : quotient, limit);
      c.highest = std::max(c.highest, value[i]);
      c.active.at(i / Activity::kStrip, j) = 1;
    }
  }
  c.emitted += added;
}

// One sweep of one colour; the values out are measured by `divisor`, or by the volume after the sweep.
void Smoke::Impl::sweep(int channel, Axis axis, const SweptVolumes& volume, const Field* divisor) {
  Channel& c = channels[channel];
  const SmokeCells& cells = volumes.cells();
  fillMargins(c, axis);
  wrapActivity(c);
  donorClusters(c, axis, volume);
  SweepJob job;
  job.axis = axis;
  job.nx = cells.nx;
  job.ny = cells.ny;
  job.periodic = axis == Axis::x ? cells.periodicX : cells.periodicY;
  job.courant = &volumes.courant(axis);
  job.volume = volume;
  job.divisor = divisor;
  job.mass = &c.mass;
  job.value = &c.value;
  job.massOut = &massOut;
  job.valueOut = &valueOut;
  job.highest = c.highest;
  job.quantum = c.quantum;
  job.irregular = &volumes.irregular().faces(axis);
  job.roots = &volumes.clusters().roots(axis);
  job.clusterMass = clusterMass.data();
  job.clusterVolume = clusterVolume.data();
  job.active = &c.active;
  job.activeOut = &activeOut;
  const SweepResult result = sweeper.run(job, pool);
  c.mass.swap(massOut);
  c.value.swap(valueOut);
  c.active.swap(activeOut);
  if (!job.periodic) c.left += result.throughHigh - result.throughLow;
  c.swept = result.highest;
}

// After the last sweep: what clusters share, what cells exchange, and what is above the ceiling.
void Smoke::Impl::end(int channel, const Boundary& b) {
  Channel& c = channels[channel];
  const float before = c.highest;
  c.highest = c.swept;
  endClusters(c, b);
  if (volumes.carries() && !volumes.plan().exchanged().empty()) {
    move(channel, volumes.plan().exchanged());
    for (const SmokeTransfer& t : volumes.plan().exchanged())
      for (int cell : {t.from, t.to}) {
        renew(c, cell, volumes.carried(), kLargest);
        c.highest = std::max(c.highest, c.value(volumes.cells().i(cell), volumes.cells().j(cell)));
      }
  }
  const auto own = [channel](const Trapped& t) { return t.channel == channel; };
  if (std::any_of(trapped.begin(), trapped.end(), own)) release(channel, b, before);
  if (c.highest > before) keepBelow(channel, b, before);
  // As thick as it was it may come back.
  const bool aside = std::any_of(trapped.begin(), trapped.end(), own);
  c.kept = aside ? std::max(c.kept, before) : 0;
  c.highest = std::max(c.highest, c.kept);
  if (c.highest > 0) c.highest = std::max(c.highest, c.highest + kBoundKept * (before - c.highest));
  if (volumes.moved())
    spread.fill(volumes.cells(), b, volumes.carried(), c.quantum, c.mass, c.value, c.active);
}

// No value above `highest`: what finds no room near by is kept aside.
void Smoke::Impl::keepBelow(int channel, const Boundary& b, float highest) {
  Channel& c = channels[channel];
  const SmokeCells& cells = volumes.cells();
  for (const MassSpread::Overflow& o :
       spread.run(cells, b, volumes.carried(), highest, c.quantum, c.mass, c.value, c.active))
    trapped.push_back({channel, o.cell, o.mass, b.regions.at(cells.i(o.cell), cells.j(o.cell))});
  c.highest = highest;
}

void Smoke::transport(const Boundary& b, const Field& u, const Field& v, double dt) {
  Impl& s = *impl_;
  SmokeVolumes& volumes = s.volumes;
  s.anyActive.clear();
  for (const Channel& c : s.channels) s.anyActive.add(c.active);
  volumes.prepare(b, u, v, dt, s.anyActive, s.pool);
  for (int k = 0; k < channels(); ++k) s.makeRoom(k, s.channels[k].highest * volumes.mostCarried());
  if (volumes.moved())
    for (Trapped& t : s.trapped)
      if (volumes.match().apart() && t.region >= 0) {
        const int heir = volumes.match().heir(t.region);
        t.region = heir >= 0 ? heir : Trapped::kVanished;
      }

  SweptVolumes volume = volumes.swept();
  for (int k = 0; k < channels(); ++k) {
    Channel& c = s.channels[k];
    if (volumes.moved()) {
      s.move(k, volumes.plan().handedOver());
      for (int cell : volumes.nodes()) s.renew(c, cell, volumes.start(), c.highest);
    }
    s.shareValues(c, volume);
  }

  const int passes = 2 * volumes.parts();
  for (int pass = 0; pass < passes; ++pass) {
    // x y, y x, x y, ... within a step and from step to step.
    const Axis axis = (((pass + 1) / 2) % 2 == 1) != s.yFirst ? Axis::y : Axis::x;
    const bool last = pass == passes - 1;
    if (last) volumes.settle(b, axis, volume);
    for (int k = 0; k < channels(); ++k)
      if (s.channels[k].highest > 0) s.sweep(k, axis, volume, last ? &volumes.measure(b) : nullptr);
    volume.swept(axis);
    if (last) break;
    for (int k = 0; k < channels(); ++k)
      if (s.channels[k].highest > 0) s.shareValues(s.channels[k], volume);
  }
  volumes.commit(b);
  for (int k = 0; k < channels(); ++k)
    if (s.channels[k].highest > 0) s.end(k, b);
  s.yFirst = !s.yFirst;
  volumes.finish(b);
}

Smoke::Totals Smoke::totals() const {
  Impl& s = *impl_;
  Totals totals;
  bool any = false;
  for (const Channel& c : s.channels) {
    totals.mass += s.pool.sum(0, c.mass.ny(), kGrain, [&](int begin, int end) {
      double sum = 0;
      for (int j = begin; j < end; ++j) {
        const float* m = c.mass.row(j);
        for (int i = 0; i < c.mass.nx(); ++i) sum += m[i];
      }
      return sum;
    });
    totals.mass += c.rounded;
    totals.emitted += c.emitted;
    totals.left += c.left;
    for (int j = 0; j < c.mass.ny(); ++j) {
      const float *r = c.value.row(j), *open = s.volumes.openShare().row(j);
      for (int i = 0; i < c.mass.nx(); ++i) {
        if (!(open[i] > 0)) continue;
        totals.min = any ? std::min(totals.min, static_cast<double>(r[i])) : r[i];
        totals.max = any ? std::max(totals.max, static_cast<double>(r[i])) : r[i];
        any = true;
      }
    }
  }
  for (const Trapped& t : s.trapped) totals.mass += t.mass;
  totals.mass *= s.cellArea;
  totals.emitted *= s.cellArea;
  totals.left *= s.cellArea;
  return totals;
}

std::size_t Smoke::bytes() const {
  const Impl& s = *impl_;
  std::size_t sum = s.volumes.bytes() + s.sweeper.bytes() + s.spread.bytes();
  for (const Channel& c : s.channels) sum += c.mass.bytes() + c.value.bytes();
  return sum + s.massOut.bytes() + s.valueOut.bytes();
}

}  // namespace smokebox

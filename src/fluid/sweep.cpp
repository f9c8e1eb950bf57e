#include "fluid/sweep.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "fluid/sweep_kernels.h"

namespace smokebox {

using namespace sweeps;

namespace {

constexpr int kStrip = Activity::kStrip;
constexpr int kMostStrips = 16;                 // of a row that are worked on together
constexpr int kTileStrips = 4, kTileRows = 32;  // of a sweep along y
constexpr int kRowGrain = 16;
constexpr int kPad = 32;
constexpr float kClusterSlack = 8;  // clusters have more faces at which fluxes are rounded
// How far smoke gets in one sweep: a cell that a donor flux reaches may hand on a correction.
constexpr int kFarthest = 2;

// Corrections at the listed faces of row j with first <= i < last; `donor` and `extra` point to face `first`.
// `d`, vLow and vHigh as above.
void patchFaces(const SweepJob& job, int j, int first, int last, std::ptrdiff_t d, const float* vLow,
                const float* vHigh, float* extra) {
  const IrregularFace* face = job.irregular->begin(j);
  const IrregularFace* const end = job.irregular->end(j);
  face = std::lower_bound(face, end, first, [](const IrregularFace& f, int i) { return f.i < i; });
  const float *c = job.courant->row(j), *r = job.value->row(j);
  for (; face != end && face->i < last; ++face) {
    const int i = face->i;
    const float flow = c[i];
    if (face->donor || flow == 0) {
      extra[i - first] = 0;
      continue;
    }
    const float l1 = r[i - d], h1 = r[i];
    float mean, mid;
    if (face->five) {
      const bool up = flow > 0;
      const float* from = up ? r + i - d : r + i;
      const std::ptrdiff_t on = up ? d : -d;
      mid = *from;
      mean = sweptMean5(from[-2 * on], from[-on], mid, from[on], from[2 * on],
                        std::min(std::fabs(flow) / (up ? vLow : vHigh)[i - first], 1.0f));
    } else if (flow > 0) {
      mid = l1;
      mean = sweptMean3(face->behindLow ? r[i - 2 * d] : l1, l1, h1, std::min(flow / vLow[i - first], 1.0f));
    } else {
      mid = h1;
      mean = sweptMean3(face->behindHigh ? r[i + d] : h1, h1, l1, std::min(-flow / vHigh[i - first], 1.0f));
    }
    extra[i - first] = flow * (std::min(std::max(mean, 0.0f), job.highest) - mid);
  }
}

// The limits of a cell that stands for a cluster.
void clusterLimits(float mass, float volume, float extraLow, float extraHigh, float highest, float slack,
                   float& in, float& out) {
  const float enters = std::max(extraLow, 0.0f) - std::min(extraHigh, 0.0f);
  const float leaves = std::max(extraHigh, 0.0f) - std::min(extraLow, 0.0f);
  in = std::min(1.0f, std::max(highest * volume - mass - slack, 0.0f) / (enters + kTiny));
  out = std::min(1.0f, std::max(mass - slack, 0.0f) / (leaves + kTiny));
}

void patchLimits(const SweepJob& job, int j, int first, int last, const float* extraLow,
                 const float* extraHigh, float slack, float* in, float* out) {
  const ClusterRoot* root = job.roots->begin(j);
  const ClusterRoot* const end = job.roots->end(j);
  root = std::lower_bound(root, end, first, [](const ClusterRoot& a, int i) { return a.i < i; });
  for (; root != end && root->i < last; ++root) {
    const int k = root->i - first;
    clusterLimits(job.clusterMass[root->cluster], job.clusterVolume[root->cluster], extraLow[k], extraHigh[k],
                  job.highest, kClusterSlack * slack, in[k], out[k]);
  }
}

// A flow into the domain through its side brings clean air.
inline void cleanInflow(float c, bool lowSide, float& donor, float& extra) {
  if (lowSide ? c > 0 : c < 0) donor = extra = 0;
}

// Empties strips [begin, end) of a row, but for those that are known to be empty.
void clear(const SweepJob& job, int begin, int end, int j) {
  for (int s = begin; (s = job.activeOut->next(s, j)) < end; ++s) {
    job.activeOut->at(s, j) = 0;
    const int first = s * kStrip;
    const std::size_t size = (std::min(job.nx, first + kStrip) - first) * sizeof(float);
    std::memset(job.massOut->row(j) + first, 0, size);
    std::memset(job.valueOut->row(j) + first, 0, size);
  }
}

// Whether a sweep along x can leave anything in a strip of a row.
bool reached(const SweepJob& job, int s, int j) {
  if (job.active->at(s, j)) return true;
  const int first = s * kStrip, last = std::min(job.nx, first + kStrip);
  const auto holds = [&](int i) {
    if (job.periodic) i = i < 0 ? i + job.nx : i >= job.nx ? i - job.nx : i;
    return i >= 0 && i < job.nx && job.active->at(i / kStrip, j) &&
           ((*job.mass)(i, j) != 0 || (*job.value)(i, j) != 0);
  };
  for (int k = 0; k < kFarthest; ++k)
    if (holds(first - 1 - k) || holds(last + k)) return true;
  return false;
}

template <int strips>
struct alignas(64) Row {
  float data[strips * kStrip + 2 * kPad];
  float* at0() { return data + kPad; }
};

}  // namespace

void SweptVolumes::swept(Axis axis) {
  bool &own = axis == Axis::x ? onlyX : onlyY, &other = axis == Axis::x ? onlyY : onlyX;
  if (!other) {
    own = true;
    return;
  }
  other = false;
  if (keepDivergence) both += 1;
}

const float* SweptVolumes::row(int first, int n, int j, float* __restrict buffer) const {
  const float* __restrict v = start->row(j) + first;
  if (both == 0 && !onlyX && !onlyY) return v;
  if (!periodicY && (j < 0 || j >= ny)) {
    std::fill_n(buffer, n, 1.0f);
    return buffer;
  }
  const float* __restrict x = courantX->row(j) + first;
  const float *low = courantY->row(j) + first, *high = courantY->row(j + 1) + first;
  if (both > 0) {
    const float b = both, once = onlyX ? 1 : 0, onceY = onlyY ? 1 : 0;
#pragma omp simd
    for (int k = 0; k < n; ++k) {
      const float netX = x[k + 1] - x[k], netY = high[k] - low[k];
      buffer[k] = v[k] - (b * (netX + netY) + (once * netX + onceY * netY));
    }
  } else if (onlyX) {
#pragma omp simd
    for (int k = 0; k < n; ++k) buffer[k] = v[k] - (x[k + 1] - x[k]);
  } else {
#pragma omp simd
    for (int k = 0; k < n; ++k) buffer[k] = v[k] - (high[k] - low[k]);
  }
  if (periodicX) return buffer;
  for (int k = 0; first + k < 0; ++k) buffer[k] = 1;
  for (int k = n - 1; first + k >= nx; --k) buffer[k] = 1;
  return buffer;
}

Sweeper::Sweeper(int nx, int ny) {
  const int columns = (nx + kTileStrips * kStrip - 1) / (kTileStrips * kStrip);
  const int tiles = columns * ((ny + kTileRows - 1) / kTileRows);
  low_.resize(std::max(ny, tiles));
  high_.resize(low_.size());
  top_.resize(low_.size());
}

std::size_t Sweeper::bytes() const { return low_.size() * (2 * sizeof(double) + sizeof(float)); }

SweepResult Sweeper::run(const SweepJob& job, ThreadPool& pool) {
  return job.axis == Axis::x ? runX(job, pool) : runY(job, pool);
}

SweepResult Sweeper::runX(const SweepJob& job, ThreadPool& pool) {
  const int nx = job.nx, strips = job.active->strips();
  const float slack = 2 * job.quantum.size;
  // Strips [begin, end) of row j; returns the largest value.
  auto run = [&](int j, int begin, int end) {
    const int first = begin * kStrip, last = std::min(nx, end * kStrip), n = last - first;
    const float *c = job.courant->row(j), *r = job.value->row(j), *m = job.mass->row(j);
    float *mOut = job.massOut->row(j), *rOut = job.valueOut->row(j);
    Row<kMostStrips> donorRow, extraRow, inRow, outRow, fluxRow, volumeRow;
    float *donor = donorRow.at0(), *extra = extraRow.at0(), *in = inRow.at0(), *out = outRow.at0(),
          *flux = fluxRow.at0();
    // Faces first - 1 .. last + 1, cells first - 1 .. last, final fluxes first .. last.
    const int faces = chunksOf(n + 3);
    // Of cell `first`.
    const float* v = job.volume.row(first - 2, faces * kLanes + 1, j, volumeRow.at0() - 2) + 2;
    fluxes(faces, c + first - 1, r + first - 1, v - 2, v - 1, 1, donor - 1, extra - 1);
    patchFaces(job, j, first - 1, last + 2, 1, v - 2, v - 1, extra - 1);
    if (!job.periodic && begin == 0) cleanInflow(c[0], true, donor[0], extra[0]);
    if (!job.periodic && end == strips) cleanInflow(c[nx], false, donor[n], extra[n]);
    limits(chunksOf(n + 2), m + first - 1, v - 1, c + first - 1, c + first, donor - 1, donor, extra - 1,
           extra, job.highest, slack, in - 1, out - 1);
    patchLimits(job, j, first - 1, last + 1, extra - 1, extra, slack, in - 1, out - 1);
    if (!job.periodic && begin == 0) in[-1] = out[-1] = 1;
    if (!job.periodic && end == strips) in[n] = out[n] = 1;
    joinFluxes(chunksOf(n + 1), c + first, r + first, 1, donor, extra, in - 1, out - 1, in, out, job.quantum,
               flux);
    const std::int32_t most = job.divisor ? updateWith(n, m + first, job.divisor->row(j) + first, flux,
                                                       flux + 1, mOut + first, rOut + first)
                                          : update(n, m + first, v, c + first, c + first + 1, flux, flux + 1,
                                                   mOut + first, rOut + first);
    markHeld(n, mOut + first, &job.activeOut->at(begin, j));
    if (begin == 0) low_[j] = flux[0];
    if (end == strips) high_[j] = flux[n];
    return most;
  };
  auto oneRow = [&](int j) {
    low_[j] = high_[j] = 0;
    std::int32_t top = 0;
    int done = 0;
    for (int s = 0; s < strips;) {
      if (!reached(job, s, j)) {
        // On to the one before the next that holds smoke; the last two may be reached through a periodic
        // side.
        s = std::max(s + 1, std::min(job.active->next(s + 1, j) - 1, strips - 2));
        continue;
      }
      int end = s + 1;
      while (end < strips && end - s < kMostStrips && reached(job, end, j)) ++end;
      clear(job, done, s, j);
      top = std::max(top, run(j, s, end));
      done = s = end;
    }
    clear(job, done, strips, j);
    top_[j] = std::bit_cast<float>(top);
  };
  pool.blocks(0, job.ny, kRowGrain, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) oneRow(j);
  });
  SweepResult result;
  for (int j = 0; j < job.ny; ++j) {
    result.throughLow += low_[j];
    result.throughHigh += high_[j];
    result.highest = std::max(result.highest, top_[j]);
  }
  return result;
}

SweepResult Sweeper::runY(const SweepJob& job, ThreadPool& pool) {
  const int nx = job.nx, ny = job.ny, strips = job.active->strips();
  const std::ptrdiff_t d = job.courant->stride();
  const float slack = 2 * job.quantum.size;
  // Strips [begin, end) of rows [j0, j1); returns the largest value.
  auto run = [&](int begin, int end, int j0, int j1, double& through0, double& through1) {
    const int first = begin * kStrip, last = std::min(nx, end * kStrip), n = last - first;
    const int chunks = end - begin;
    std::int32_t top = 0;
    // Rings of rows: faces j, j + 1 and limits of cells j - 1, j are alive at once.
    Row<kTileStrips> donorRing[2], extraRing[2], inRing[2], outRing[2], fluxRing[2];
    auto ring = [](Row<kTileStrips>* rows, int j) { return rows[j & 1].at0(); };
    Row<kTileStrips> volumeRing[4];
    const float* volumes[4];
    auto volumeAt = [&](int j) -> const float*& { return volumes[j & 3]; };
    auto findVolume = [&](int j) {
      volumeAt(j) = job.volume.row(first, chunks * kLanes, j, volumeRing[j & 3].at0());
    };
    findVolume(j0 - 2);
    auto face = [&](int j) {
      findVolume(j);
      float *donor = ring(donorRing, j), *extra = ring(extraRing, j);
      const float* c = job.courant->row(j) + first;
      // A face beyond a periodic side is one within, for which the margins are wide enough.
      const int within = !job.periodic ? j : j < 0 ? j + ny : j > ny ? j - ny : j;
      fluxes(chunks, c, job.value->row(within) + first, volumeAt(j - 1), volumeAt(j), d, donor, extra);
      patchFaces(job, j, first, last, d, volumeAt(j - 1), volumeAt(j), extra);
      if (!job.periodic && (j == 0 || j == ny))
        for (int k = 0; k < n; ++k) cleanInflow(c[k], j == 0, donor[k], extra[k]);
    };
    face(j0 - 1);
    for (int j = j0 - 1; j <= j1; ++j) {
      const float *cLow = job.courant->row(j) + first, *cHigh = job.courant->row(j + 1) + first;
      // The final flux of face j needs what face(j + 1) would overwrite only in the ring's other place.
      face(j + 1);
      float *in = ring(inRing, j), *out = ring(outRing, j);
      if (!job.periodic && (j < 0 || j >= ny)) {
        std::fill_n(in, chunks * kLanes, 1.0f);
        std::fill_n(out, chunks * kLanes, 1.0f);
      } else {
        limits(chunks, job.mass->row(j) + first, volumeAt(j), cLow, cHigh, ring(donorRing, j),
               ring(donorRing, j + 1), ring(extraRing, j), ring(extraRing, j + 1), job.highest, slack, in,
               out);
        patchLimits(job, j, first, last, ring(extraRing, j), ring(extraRing, j + 1), slack, in, out);
      }
      if (j < j0) continue;
      float* flux = ring(fluxRing, j);
      joinFluxes(chunks, cLow, job.value->row(j) + first, d, ring(donorRing, j), ring(extraRing, j),
                 ring(inRing, j - 1), ring(outRing, j - 1), in, out, job.quantum, flux);
      if (j == 0)
        for (int k = 0; k < n; ++k) through0 += flux[k];
      if (j == ny)
        for (int k = 0; k < n; ++k) through1 += flux[k];
      if (j == j0) continue;
      const int i = j - 1;  // the row of cells between the last two faces
      const float* m = job.mass->row(i) + first;
      float *mOut = job.massOut->row(i) + first, *rOut = job.valueOut->row(i) + first;
      const std::int32_t most =
          job.divisor ? updateWith(n, m, job.divisor->row(i) + first, ring(fluxRing, i), flux, mOut, rOut)
                      : update(n, m, volumeAt(i), job.courant->row(i) + first, cLow, ring(fluxRing, i), flux,
                               mOut, rOut);
      markHeld(n, mOut, &job.activeOut->at(begin, i));
      top = std::max(top, most);
    }
    return top;
  };
  const int columns = (strips + kTileStrips - 1) / kTileStrips;
  auto tile = [&](int index) {
    const int begin = index % columns * kTileStrips, end = std::min(strips, begin + kTileStrips);
    const int j0 = index / columns * kTileRows, j1 = std::min(ny, j0 + kTileRows);
    low_[index] = high_[index] = 0;
    top_[index] = 0;
    if (!job.active->any(begin, end, j0 - kFarthest, j1 + kFarthest)) {
      for (int j = j0; job.activeOut->any(begin, end, j, j1); ++j) clear(job, begin, end, j);
      return;
    }
    // What the sweep can reach.
    int left = end, right = begin, bottom = j1, top = j0;
    for (int j = j0 - kFarthest; j < j1 + kFarthest; ++j) {
      const int from = job.active->next(begin, j);
      if (from >= end) continue;
      left = std::min(left, from);
      for (int s = from; s < end; ++s)
        if (job.active->at(s, j)) right = std::max(right, s + 1);
      bottom = std::min(bottom, j - kFarthest);
      top = std::max(top, j + 1 + kFarthest);
    }
    bottom = std::max(bottom, j0);
    top = std::min(top, j1);
    for (int j = j0; j < j1; ++j) {
      const bool within = j >= bottom && j < top;
      clear(job, begin, within ? left : end, j);
      if (within) clear(job, right, end, j);
    }
    if (bottom < top)
      top_[index] = std::bit_cast<float>(run(left, right, bottom, top, low_[index], high_[index]));
  };
  const int tiles = columns * ((ny + kTileRows - 1) / kTileRows);
  pool.blocks(0, tiles, 1, [&](int begin, int end) {
    for (int k = begin; k < end; ++k) tile(k);
  });
  SweepResult result;
  for (int k = 0; k < tiles; ++k) {
    result.throughLow += low_[k];
    result.throughHigh += high_[k];
    result.highest = std::max(result.highest, top_[k]);
  }
  return result;
}

}  // namespace smokebox

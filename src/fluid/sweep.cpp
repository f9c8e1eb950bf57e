#include "fluid/sweep.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace smokebox {
namespace {

constexpr int kStrip = Activity::kStrip;
constexpr int kTileRows = 32;
constexpr int kRowGrain = 16;
constexpr int kPad = 32;
constexpr float kTiny = 1e-30f;
// Fluxes out of cells with less than this many quanta are rounded towards zero, so that none is overdrawn.
constexpr float kRoundingFloor = 1024;
constexpr float kClusterSlack = 8;  // clusters have more faces at which fluxes are rounded

// The donor flux through faces [0, n) and what the reconstruction adds to it. Pointers are to the first face;
// `d` is the distance between a face's high cell and its low cell.
template <class Step>
void fluxes(int n, const float* __restrict c, const float* __restrict r, const float* __restrict vLow,
            const float* __restrict vHigh, Step d, float* __restrict donor, float* __restrict extra) {
#pragma omp simd
  for (int k = 0; k < n; ++k) {
    const float flow = c[k];
    const bool up = flow > 0;
    const float l4 = r[k - 4 * d], l3 = r[k - 3 * d], l2 = r[k - 2 * d], l1 = r[k - d];
    const float h1 = r[k], h2 = r[k + d], h3 = r[k + 2 * d], h4 = r[k + 3 * d];
    const float z = up ? l4 : h4, a = up ? l3 : h3, b = up ? l2 : h2, mid = up ? l1 : h1;
    const float e = up ? h1 : l1, f = up ? h2 : l2, y = up ? h3 : l3;
    const float vUp = up ? vLow[k] : vHigh[k];
    const float g = std::min(std::fabs(flow) / vUp, 1.0f);
    const float t1 = e - b, t2 = (e - mid) - (mid - b);
    const float t3 = (f - a) - 2 * t1, t4 = ((f - mid) - (mid - a)) - 4 * t2;
    const float t5 = (y - z) - 4 * t3 - 3 * t1, t6 = ((y - mid) - (mid - z)) - 6 * t4 - 9 * t2;
    const float s = 1 - 2 * g, bend = g * (1 - g), w3 = (2 + bend) * (1.0f / 12),
                w5 = (6 + bend) * (1.0f / 30);
    const float above =
        t1 + s * (1.0f / 3) * t2 - w3 * (t3 + s * 0.2f * t4 - w5 * (t5 + s * (1.0f / 7) * t6));
    donor[k] = flow * mid;
    extra[k] = flow * (0.25f * (1 - g) * above);
  }
}

// By value: std::min and std::max hand out references, which keeps GCC 12 from vectorising the loops below.
inline float larger(float a, float b) { return a > b ? a : b; }
inline float smaller(float a, float b) { return a < b ? a : b; }

// Zalesak's limits: which part of the corrections may flow into a cell (`in`) and out of it (`out`).
void limits(int n, const float* __restrict m, const float* __restrict v, const float* __restrict cLow,
            const float* __restrict cHigh, const float* __restrict donorLow,
            const float* __restrict donorHigh, const float* __restrict extraLow,
            const float* __restrict extraHigh, float highest, float slack, float* __restrict in,
            float* __restrict out) {
#pragma omp simd
  for (int k = 0; k < n; ++k) {
    const float vNext = v[k] - (cHigh[k] - cLow[k]);
    const float mDonor = m[k] - (donorHigh[k] - donorLow[k]);
    const float enters = larger(extraLow[k], 0.0f) - smaller(extraHigh[k], 0.0f);
    const float leaves = larger(extraHigh[k], 0.0f) - smaller(extraLow[k], 0.0f);
    const float room = larger(highest * vNext - mDonor - slack, 0.0f), stock = larger(mDonor - slack, 0.0f);
    in[k] = smaller(1.0f, room / (enters + kTiny));
    out[k] = smaller(1.0f, stock / (leaves + kTiny));
  }
}

// The limits of a cell that stands for a cluster.
void clusterLimits(float mass, float volume, float extraLow, float extraHigh, float highest, float slack,
                   float& in, float& out) {
  const float enters = larger(extraLow, 0.0f) - smaller(extraHigh, 0.0f);
  const float leaves = larger(extraHigh, 0.0f) - smaller(extraLow, 0.0f);
  in = smaller(1.0f, larger(highest * volume - mass - slack, 0.0f) / (enters + kTiny));
  out = smaller(1.0f, larger(mass - slack, 0.0f) / (leaves + kTiny));
}

// The final flux, a whole number of quanta.
template <class Step>
void joinFluxes(int n, const float* __restrict c, const float* __restrict r, Step d,
                const float* __restrict donor, const float* __restrict extra, const float* __restrict inLow,
                const float* __restrict outLow, const float* __restrict inHigh,
                const float* __restrict outHigh, Quantum q, float* __restrict flux) {
  const float floorValue = kRoundingFloor * q.size;
#pragma omp simd
  for (int k = 0; k < n; ++k) {
    const float up = smaller(inHigh[k], outLow[k]), down = smaller(inLow[k], outHigh[k]);
    const float share = extra[k] > 0 ? up : down;
    const float x = (donor[k] + extra[k] * share) * q.inverse;
    const float upwind = c[k] > 0 ? r[k - d] : r[k];
    const float half = upwind >= floorValue ? 0.5f : 0.0f;
    flux[k] = static_cast<float>(static_cast<std::int32_t>(x + (x < 0 ? -half : half))) * q.size;
  }
}

// Non-negative floats are ordered as their bits are, and integers reduce in vectors.
struct Largest {
  std::int32_t mass = 0, value = 0;
};

Largest update(int n, const float* __restrict m, const float* __restrict v, const float* __restrict cLow,
               const float* __restrict cHigh, const float* __restrict fluxLow,
               const float* __restrict fluxHigh, float* __restrict mOut, float* __restrict rOut) {
  std::int32_t mass = 0, value = 0;
#pragma omp simd reduction(max : mass, value)
  for (int k = 0; k < n; ++k) {
    const float next = m[k] - (fluxHigh[k] - fluxLow[k]);
    const float ratio = next / (v[k] - (cHigh[k] - cLow[k]));
    mOut[k] = next;
    rOut[k] = ratio;
    mass = std::max(mass, std::bit_cast<std::int32_t>(next));
    value = std::max(value, std::bit_cast<std::int32_t>(ratio));
  }
  return {mass, value};
}

Largest updateWith(int n, const float* __restrict m, const float* __restrict divisor,
                   const float* __restrict fluxLow, const float* __restrict fluxHigh, float* __restrict mOut,
                   float* __restrict rOut) {
  std::int32_t mass = 0, value = 0;
#pragma omp simd reduction(max : mass, value)
  for (int k = 0; k < n; ++k) {
    const float next = m[k] - (fluxHigh[k] - fluxLow[k]), by = divisor[k];
    const float quotient = next / (by > 0 ? by : 1.0f);
    const float ratio = by > 0 ? quotient : 0.0f;
    mOut[k] = next;
    rOut[k] = ratio;
    mass = std::max(mass, std::bit_cast<std::int32_t>(next));
    value = std::max(value, std::bit_cast<std::int32_t>(ratio));
  }
  return {mass, value};
}

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

// Empties a strip of a row, unless what it held before says that it is empty.
void clear(const SweepJob& job, int s, int j) {
  std::uint8_t& held = job.activeOut->at(s, j);
  if (!held) return;
  held = 0;
  const int first = s * kStrip;
  const std::size_t size = (std::min(job.nx, first + kStrip) - first) * sizeof(float);
  std::memset(job.massOut->row(j) + first, 0, size);
  std::memset(job.valueOut->row(j) + first, 0, size);
}

struct alignas(64) Row {
  float data[kStrip + 2 * kPad];
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
  const int strips = (nx + kStrip - 1) / kStrip, tiles = strips * ((ny + kTileRows - 1) / kTileRows);
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
  auto oneRow = [&](int j) {
    low_[j] = high_[j] = 0;
    std::int32_t top = 0;
    const float *c = job.courant->row(j), *r = job.value->row(j), *m = job.mass->row(j);
    float *mOut = job.massOut->row(j), *rOut = job.valueOut->row(j);
    for (int s = 0; s < strips; ++s) {
      const int first = s * kStrip, last = std::min(nx, first + kStrip), n = last - first;
      const bool wrap = job.periodic && (s == 0 || s == strips - 1);
      if (!job.active->at(s, j) && (s == 0 || !job.active->at(s - 1, j)) &&
          (s == strips - 1 || !job.active->at(s + 1, j)) &&
          !(wrap && (job.active->at(0, j) || job.active->at(strips - 1, j)))) {
        clear(job, s, j);
        continue;
      }
      Row donorRow, extraRow, inRow, outRow, fluxRow, volumeRow;
      float *donor = donorRow.at0(), *extra = extraRow.at0(), *in = inRow.at0(), *out = outRow.at0(),
            *flux = fluxRow.at0();
      const float* v = job.volume.row(first - 2, n + 4, j, volumeRow.at0() - 2) + 2;  // of cell `first`
      // Faces first - 1 .. last + 1, cells first - 1 .. last, final fluxes first .. last.
      fluxes(n + 3, c + first - 1, r + first - 1, v - 2, v - 1, 1, donor - 1, extra - 1);
      patchFaces(job, j, first - 1, last + 2, 1, v - 2, v - 1, extra - 1);
      if (!job.periodic && s == 0) cleanInflow(c[0], true, donor[0], extra[0]);
      if (!job.periodic && s == strips - 1) cleanInflow(c[nx], false, donor[n], extra[n]);
      limits(n + 2, m + first - 1, v - 1, c + first - 1, c + first, donor - 1, donor, extra - 1, extra,
             job.highest, slack, in - 1, out - 1);
      patchLimits(job, j, first - 1, last + 1, extra - 1, extra, slack, in - 1, out - 1);
      if (!job.periodic && s == 0) in[-1] = out[-1] = 1;
      if (!job.periodic && s == strips - 1) in[n] = out[n] = 1;
      joinFluxes(n + 1, c + first, r + first, 1, donor, extra, in - 1, out - 1, in, out, job.quantum, flux);
      const Largest most = job.divisor ? updateWith(n, m + first, job.divisor->row(j) + first, flux, flux + 1,
                                                    mOut + first, rOut + first)
                                       : update(n, m + first, v, c + first, c + first + 1, flux, flux + 1,
                                                mOut + first, rOut + first);
      if (s == 0) low_[j] = flux[0];
      if (s == strips - 1) high_[j] = flux[n];
      job.activeOut->at(s, j) = most.mass > 0;
      top = std::max(top, most.value);
    }
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
  auto tile = [&](int index) {
    const int s = index % strips, first = s * kStrip, last = std::min(nx, first + kStrip), n = last - first;
    const int j0 = index / strips * kTileRows, j1 = std::min(ny, j0 + kTileRows);
    low_[index] = high_[index] = 0;
    top_[index] = 0;
    bool any = false;
    for (int j = j0 - 4; j < j1 + 4 && !any; ++j) any = job.active->at(s, j);
    if (!any) {
      for (int j = j0; j < j1; ++j) clear(job, s, j);
      return;
    }
    std::int32_t top = 0;
    // Rings of rows: faces j, j + 1 and limits of cells j - 1, j are alive at once.
    Row donorRing[2], extraRing[2], inRing[2], outRing[2], fluxRing[2];
    auto ring = [](Row* rows, int j) { return rows[j & 1].at0(); };
    Row volumeRing[4];
    const float* volumes[4];
    auto volumeAt = [&](int j) -> const float*& { return volumes[j & 3]; };
    auto findVolume = [&](int j) { volumeAt(j) = job.volume.row(first, n, j, volumeRing[j & 3].at0()); };
    findVolume(j0 - 2);
    auto face = [&](int j) {
      findVolume(j);
      float *donor = ring(donorRing, j), *extra = ring(extraRing, j);
      const float* c = job.courant->row(j) + first;
      // A face beyond a periodic side is one within, for which the margins are wide enough.
      const int within = !job.periodic ? j : j < 0 ? j + ny : j > ny ? j - ny : j;
      fluxes(n, c, job.value->row(within) + first, volumeAt(j - 1), volumeAt(j), d, donor, extra);
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
        std::fill_n(in, n, 1.0f);
        std::fill_n(out, n, 1.0f);
      } else {
        limits(n, job.mass->row(j) + first, volumeAt(j), cLow, cHigh, ring(donorRing, j),
               ring(donorRing, j + 1), ring(extraRing, j), ring(extraRing, j + 1), job.highest, slack, in,
               out);
        patchLimits(job, j, first, last, ring(extraRing, j), ring(extraRing, j + 1), slack, in, out);
      }
      if (j < j0) continue;
      float* flux = ring(fluxRing, j);
      joinFluxes(n, cLow, job.value->row(j) + first, d, ring(donorRing, j), ring(extraRing, j),
                 ring(inRing, j - 1), ring(outRing, j - 1), in, out, job.quantum, flux);
      if (j == 0)
        for (int k = 0; k < n; ++k) low_[index] += flux[k];
      if (j == ny)
        for (int k = 0; k < n; ++k) high_[index] += flux[k];
      if (j == j0) continue;
      const int i = j - 1;  // the row of cells between the last two faces
      const float* m = job.mass->row(i) + first;
      float *mOut = job.massOut->row(i) + first, *rOut = job.valueOut->row(i) + first;
      const Largest most =
          job.divisor ? updateWith(n, m, job.divisor->row(i) + first, ring(fluxRing, i), flux, mOut, rOut)
                      : update(n, m, volumeAt(i), job.courant->row(i) + first, cLow, ring(fluxRing, i), flux,
                               mOut, rOut);
      job.activeOut->at(s, i) = most.mass > 0;
      top = std::max(top, most.value);
    }
    top_[index] = std::bit_cast<float>(top);
  };
  const int tiles = strips * ((ny + kTileRows - 1) / kTileRows);
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

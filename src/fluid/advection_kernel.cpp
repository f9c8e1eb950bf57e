#include "fluid/advection_kernel.h"

#include <algorithm>
#include <cmath>

#include "base/lanes.h"

namespace smokebox {

namespace {

constexpr int kTile =
    256;  // columns that are worked on at a time: the flux rows stay in the first-level cache
constexpr int kLine = kTile + 64;
constexpr int kLead = 16;  // column 0 of a tile within a line

// What the unnormalised weights below leave out: 1/16 of the transport velocity, 1/256 of the value, 1/24 of
// the difference.
constexpr float kFluxScale = 1.0f / (16.0f * 256.0f * 24.0f);

/// Unnormalised flux between p[0] and p[step] at a transport velocity U (16 times its size).
inline float flux(float U, const float* p, std::ptrdiff_t step) {
  const float a = p[0], b = p[step], m1 = p[-step], p1 = p[2 * step], m2 = p[-2 * step], p2 = p[3 * step];
  const float even = (150 * (a + b) - 25 * (m1 + p1)) + 3 * (m2 + p2);
  const float odd = 3 * (((p2 - m2) - 5 * (p1 - m1)) + 10 * (b - a));
  return U * even - std::fabs(U) * odd;
}

/// 16 times the 4-point interpolation between p[0] and p[step].
inline float transport(const float* p, std::ptrdiff_t step) {
  return 9 * (p[0] + p[step]) - (p[-step] + p[2 * step]);
}

/// line[i] = flux between q[i] and q[i + step], carried by `carrier` interpolated along carrierStep.
inline void fluxLine(const float* carrier, std::ptrdiff_t carrierStep, const float* q, std::ptrdiff_t step,
                     int begin, int end, float* __restrict line) {
#pragma omp simd
  for (int i = begin; i < end; ++i) line[i] = flux(transport(carrier + i, carrierStep), q + i, step);
}

/// line[i] = accelerationScale a - phiScale (phi - back), back being phi of the cell behind.
inline void impulseLine(const AdvectionStage& s, const float* phi, const float* back,
                        const float* acceleration, int count, float* __restrict line) {
  const float ps = s.phiScale, as = s.accelerationScale;
  if (acceleration) {
#pragma omp simd
    for (int i = 0; i < count; ++i) line[i] = as * acceleration[i] - ps * (phi[i] - back[i]);
  } else {
#pragma omp simd
    for (int i = 0; i < count; ++i) line[i] = -(ps * (phi[i] - back[i]));
  }
}

/// out = base + impulse - scale * (difference along x + difference along y); x[-1], x[0], x[1], x[2] and y0
/// .. y3 are the fluxes around the face, in order.
inline void finishLine(const float* base, const float* impulse, const float* x, const float* y0,
                       const float* y1, const float* y2, const float* y3, float scale, int count,
                       float* out) {
#pragma omp simd
  for (int i = 0; i < count; ++i) {
    const float dx = 27 * (x[i + 1] - x[i]) - (x[i + 2] - x[i - 1]);
    const float dy = 27 * (y2[i] - y1[i]) - (y3[i] - y0[i]);
    out[i] = base[i] + (impulse[i] - scale * (dx + dy));
  }
}

/// Asks for the columns from x0 on of a row that comes next, of fields larger than a cache.
inline void expectRow(const Field* field, int j, int x0, int count) {
  constexpr long kLarge = 1 << 17;
  if (!field || static_cast<long>(field->nx()) * field->ny() < kLarge) return;
  const float* row = field->row(j) + x0;
  for (int i = 0; i < count; i += kLanes) expect(row + i);
}

struct Lines {
  alignas(64) float x[kLine], impulse[kLine], y[4][kLine];
};

}  // namespace

void advanceRowsOfU(const AdvectionStage& s, int begin, int end) {
  const int nx = s.u->nx();
  const std::ptrdiff_t stride = s.u->stride();
  const float scale = s.rateScale * kFluxScale;
  Lines lines;
  for (int x0 = 0; x0 < nx; x0 += kTile) {
    const int count = std::min(kTile, nx - x0);
    float* y[4] = {lines.y[0] + kLead, lines.y[1] + kLead, lines.y[2] + kLead, lines.y[3] + kLead};
    // y-fluxes at the nodes of row r, between u(r - 1) and u(r).
    auto nodeLine = [&](int r, float* line) {
      fluxLine(s.v->row(r) + x0 - 1, 1, s.u->row(r - 1) + x0, stride, 0, count, line);
    };
    for (int k = 0; k < 3; ++k) nodeLine(begin - 1 + k, y[k]);
    for (int j = begin; j < end; ++j) {
      expectRow(s.u, j + 5, x0, count);
      expectRow(s.v, j + 3, x0, count);
      for (const Field* field : {s.baseU, s.phi, s.accelerationU, static_cast<const Field*>(s.outU)})
        expectRow(field, j + 1, x0, count);
      nodeLine(j + 2, y[3]);
      // x-fluxes at the centres i - 1 of faces i = -1 .. : x[i] is left of face i.
      float* x = lines.x + kLead;
      fluxLine(s.u->row(j) + x0 - 1, 1, s.u->row(j) + x0 - 1, 1, -1, count + 2, x);
      const float* phi = s.phi->row(j) + x0;
      impulseLine(s, phi, phi - 1, s.accelerationU ? s.accelerationU->row(j) + x0 : nullptr, count,
                  lines.impulse);
      if (x0 == 0 && s.periodicX)
        lines.impulse[0] = (s.accelerationU ? s.accelerationScale * (*s.accelerationU)(0, j) : 0.0f) -
                           s.phiScale * (phi[0] - phi[nx - 1]);
      finishLine(s.baseU->row(j) + x0, lines.impulse, x, y[0], y[1], y[2], y[3], scale, count,
                 s.outU->row(j) + x0);
      std::rotate(y, y + 1, y + 4);
    }
  }
}

void advanceRowsOfV(const AdvectionStage& s, int begin, int end) {
  const int nx = s.v->nx(), ny = s.v->ny();
  const std::ptrdiff_t stride = s.v->stride();
  const float scale = s.rateScale * kFluxScale;
  Lines lines;
  for (int x0 = 0; x0 < nx; x0 += kTile) {
    const int count = std::min(kTile, nx - x0);
    float* y[4] = {lines.y[0] + kLead, lines.y[1] + kLead, lines.y[2] + kLead, lines.y[3] + kLead};
    // y-fluxes at the centres of row r, between v(r) and v(r + 1).
    auto centreLine = [&](int r, float* line) {
      const float* v = s.v->row(r) + x0;
      fluxLine(v, stride, v, stride, 0, count, line);
    };
    for (int k = 0; k < 3; ++k) centreLine(begin - 2 + k, y[k]);
    for (int j = begin; j < end; ++j) {
      expectRow(s.v, j + 5, x0, count);
      expectRow(s.u, j + 2, x0, count);
      for (const Field* field : {s.baseV, s.phi, s.accelerationV, static_cast<const Field*>(s.outV)})
        expectRow(field, j + 1, x0, count);
      centreLine(j + 1, y[3]);
      // x-fluxes at the nodes i, left of face i, between v(i - 1) and v(i).
      float* x = lines.x + kLead;
      fluxLine(s.u->row(j - 1) + x0, stride, s.v->row(j) + x0 - 1, 1, -1, count + 2, x);
      const float* phi = s.phi->row(j) + x0;
      const float* below = s.phi->row(j == 0 && s.periodicY ? ny - 1 : j - 1) + x0;
      impulseLine(s, phi, below, s.accelerationV ? s.accelerationV->row(j) + x0 : nullptr, count,
                  lines.impulse);
      finishLine(s.baseV->row(j) + x0, lines.impulse, x, y[0], y[1], y[2], y[3], scale, count,
                 s.outV->row(j) + x0);
      std::rotate(y, y + 1, y + 4);
    }
  }
}

}  // namespace smokebox

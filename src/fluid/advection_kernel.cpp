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

/// Goes along a row, chunk by chunk: what lies beside the values of one, by so many columns.
class Beside {
 public:
#ifdef __AVX512F__
  // From aligned loads: those across two lines of the cache take twice as long.
  SMOKEBOX_INLINE explicit Beside(const float* p) : here_(load(p - kLanes)), ahead_(load(p)) {}
  SMOKEBOX_INLINE void at(const float* p) {
    before_ = here_;
    here_ = ahead_;
    ahead_ = load(p + kLanes);
  }
  template <int columns>
  SMOKEBOX_INLINE Lanes by() const {
    const LaneMask lanes = laneNumbers() + (columns + kLanes) % kLanes;
    if constexpr (columns == 0) return here_;
    return columns < 0 ? __builtin_shuffle(before_, here_, lanes) : __builtin_shuffle(here_, ahead_, lanes);
  }

 private:
  Lanes before_ = {}, here_, ahead_;
#else
  SMOKEBOX_INLINE explicit Beside(const float* p) : here_(p) {}
  SMOKEBOX_INLINE void at(const float* p) { here_ = p; }
  template <int columns>
  SMOKEBOX_INLINE Lanes by() const {
    return load(here_ + columns);
  }

 private:
  const float* here_;
#endif
};

/// Six values in a row, the flux point being in the middle.
struct Six {
  Lanes m2, m1, a, b, p1, p2;
  static SMOKEBOX_INLINE Six along(const Beside& p) {  // between the two before the one here
    return {p.by<-4>(), p.by<-3>(), p.by<-2>(), p.by<-1>(), p.by<0>(), p.by<1>()};
  }
  static SMOKEBOX_INLINE Six across(const float* p, std::ptrdiff_t step) {  // between p[0] and p[step]
    return {load(p - 2 * step), load(p - step),     load(p),
            load(p + step),     load(p + 2 * step), load(p + 3 * step)};
  }
};

/// 16 times the 4-point interpolation between a and b.
SMOKEBOX_INLINE Lanes transport(const Lanes& m1, const Lanes& a, const Lanes& b, const Lanes& p1) {
  return 9.0f * (a + b) - (m1 + p1);
}

/// Unnormalised flux at a transport velocity U (16 times its size).
SMOKEBOX_INLINE Lanes flux(const Lanes& U, const Six& q) {
  const Lanes even = (150.0f * (q.a + q.b) - 25.0f * (q.m1 + q.p1)) + 3.0f * (q.m2 + q.p2);
  const Lanes odd = 3.0f * (((q.p2 - q.m2) - 5.0f * (q.p1 - q.m1)) + 10.0f * (q.b - q.a));
  return U * even - magnitude(U) * odd;
}

/// A row of a stage, from where its fluxes are known: x[-1], x[0], x[1], x[2] and y[0] .. y[3] are those
/// around the face, in order. `back`: phi of the cell behind; `first`: of the one behind the first face.
struct Finish {
  const float *base, *phi, *back;
  float first;
  const float* acceleration;  // may be null
  float phiScale, accelerationScale, scale;

  SMOKEBOX_INLINE Lanes at(int i, const Lanes& behind, const Beside& x, const float* const* y) const {
    const Lanes dx = 27.0f * (x.by<2>() - x.by<1>()) - (x.by<3>() - x.by<0>());
    const Lanes dy = 27.0f * (load(y[2] + i) - load(y[1] + i)) - (load(y[3] + i) - load(y[0] + i));
    const Lanes push = phiScale * (load(phi + i) - behind);
    const Lanes impulse = acceleration ? accelerationScale * load(acceleration + i) - push : Lanes{} - push;
    return load(base + i) + (impulse - scale * (dx + dy));
  }
  inline void row(const float* x, const float* const* y, int count, float* __restrict out) const {
    const LaneMask place = laneNumbers();
    int i = 0;
    Beside beside(x - 1);
    const auto next = [&](const Lanes& behind) __attribute__((always_inline)) {
      beside.at(x + i - 1);
      const Lanes value = at(i, behind, beside, y);
      store(out + i, i + kLanes <= count ? value : select(place < count - i, value, load(out + i)));
      i += kLanes;
    };
    next(select(place == 0, Lanes{} + first, load(back)));
    while (i < count) next(load(back + i));
  }
};

/// Asks for the columns from x0 on of a row that comes next, of fields larger than a cache.
inline void expectRow(const Field* field, int j, int x0, int count) {
  constexpr long kLarge = 1 << 17;
  if (!field || static_cast<long>(field->nx()) * field->ny() < kLarge) return;
  const float* row = field->row(j) + x0;
  for (int i = 0; i < count; i += kLanes) expect(row + i);
}

struct Lines {
  alignas(64) float x[kLine], y[4][kLine];
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
    auto nodeFlux = [&](int i, const Beside& v, const float* u) __attribute__((always_inline)) {
      return flux(transport(v.by<-2>(), v.by<-1>(), v.by<0>(), v.by<1>()), Six::across(u + i, stride));
    };
    for (int k = 0; k < 3; ++k) {
      const float *v = s.v->row(begin - 1 + k) + x0, *u = s.u->row(begin - 2 + k) + x0;
      Beside carrier(v);
      for (int i = 0; i < count; i += kLanes) {
        carrier.at(v + i);
        store(y[k] + i, nodeFlux(i, carrier, u));
      }
    }
    for (int j = begin; j < end; ++j) {
      expectRow(s.u, j + 5, x0, count);
      expectRow(s.v, j + 3, x0, count);
      for (const Field* field : {s.baseU, s.phi, s.accelerationU, static_cast<const Field*>(s.outU)})
        expectRow(field, j + 1, x0, count);
      // x-fluxes at the centres i - 1 of faces i = -1 .. : x[i] is left of face i.
      float* x = lines.x + kLead + 1;
      const float *u = s.u->row(j) + x0, *phi = s.phi->row(j) + x0;
      const float *v = s.v->row(j + 2) + x0, *above = s.u->row(j + 1) + x0;
      Beside carrier(v), along(u);
      for (int i = 0; i < count + kLanes; i += kLanes) {
        along.at(u + i);
        const Six q = Six::along(along);
        store(x + i - 1, flux(transport(q.m1, q.a, q.b, q.p1), q));
        if (i >= count) break;
        carrier.at(v + i);
        store(y[3] + i, nodeFlux(i, carrier, above));
      }
      const float first = x0 == 0 && s.periodicX ? phi[nx - 1] : phi[-1];
      const Finish finish{s.baseU->row(j) + x0,
                          phi,
                          phi - 1,
                          first,
                          s.accelerationU ? s.accelerationU->row(j) + x0 : nullptr,
                          s.phiScale,
                          s.accelerationScale,
                          scale};
      finish.row(x, y, count, s.outU->row(j) + x0);
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
    auto centreFlux = [&](int i, const float* v) __attribute__((always_inline)) {
      const Six q = Six::across(v + i, stride);
      return flux(transport(q.m1, q.a, q.b, q.p1), q);
    };
    for (int k = 0; k < 3; ++k)
      for (int i = 0; i < count; i += kLanes) store(y[k] + i, centreFlux(i, s.v->row(begin - 2 + k) + x0));
    for (int j = begin; j < end; ++j) {
      expectRow(s.v, j + 5, x0, count);
      expectRow(s.u, j + 2, x0, count);
      for (const Field* field : {s.baseV, s.phi, s.accelerationV, static_cast<const Field*>(s.outV)})
        expectRow(field, j + 1, x0, count);
      // x-fluxes at the nodes i, left of face i, between v(i - 1) and v(i).
      float* x = lines.x + kLead + 1;
      const float *v = s.v->row(j) + x0, *u = s.u->row(j - 1) + x0;
      // The transport velocity there: at the chunk, and, of the chunk before, at its last node.
      auto carrier = [&](int i) __attribute__((always_inline)) {
        const float* c = u + i;
        return transport(load(c - stride), load(c), load(c + stride), load(c + 2 * stride));
      };
      Beside along(v);
      Lanes before = carrier(-kLanes);
      for (int i = 0; i < count + kLanes; i += kLanes) {
        along.at(v + i);
        const Lanes here = carrier(i);
        store(x + i - 1, flux(lastAndRest(before, here), Six::along(along)));
        before = here;
        if (i >= count) break;
        store(y[3] + i, centreFlux(i, v + stride));
      }
      const float* phi = s.phi->row(j) + x0;
      const float* below = s.phi->row(j == 0 && s.periodicY ? ny - 1 : j - 1) + x0;
      const Finish finish{s.baseV->row(j) + x0,
                          phi,
                          below,
                          below[0],
                          s.accelerationV ? s.accelerationV->row(j) + x0 : nullptr,
                          s.phiScale,
                          s.accelerationScale,
                          scale};
      finish.row(x, y, count, s.outV->row(j) + x0);
      std::rotate(y, y + 1, y + 4);
    }
  }
}

}  // namespace smokebox

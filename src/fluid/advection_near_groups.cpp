// Near faces side by side, done together: lane by lane what advection_near.cpp does face by face.
#include "base/lanes.h"
#include "fluid/advection_near.h"

namespace smokebox {

namespace {

struct Orders {
  LaneMask third, fifth;
  SMOKEBOX_INLINE Lanes weight(const float (&w)[3][3], int k) const {
    return select(fifth, Lanes{} + w[2][k], select(third, Lanes{} + w[1][k], Lanes{} + w[0][k]));
  }
};

/// U (value at the flux point - q); p: the lower face of the flux point.
SMOKEBOX_INLINE Lanes carriedBy(const Lanes& U, const float* p, std::ptrdiff_t step, const Lanes& q,
                                const Orders& by, const float (&evens)[3][3], const float (&odds)[3][3]) {
  const Lanes a = load(p), b = load(p + step), m1 = load(p - step), p1 = load(p + 2 * step),
              m2 = load(p - 2 * step), p2 = load(p + 3 * step);
  const Lanes even =
      (by.weight(evens, 0) * (a + b) + by.weight(evens, 1) * (m1 + p1)) + by.weight(evens, 2) * (m2 + p2);
  const Lanes odd =
      (by.weight(odds, 0) * (b - a) + by.weight(odds, 1) * (p1 - m1)) + by.weight(odds, 2) * (p2 - m2);
  return U * (even - q) - magnitude(U) * odd;
}

}  // namespace

void NearFaces::advanceGroups(const AdvectionStage& s, int begin, int end) const {
  const std::ptrdiff_t stride = s.u->stride();
  for (const bool alongX : {true, false}) {
    const Component& c = alongX ? u_ : v_;
    const Field &in = alongX ? *s.u : *s.v, &base = alongX ? *s.baseU : *s.baseV;
    const Field* acceleration = alongX ? s.accelerationU : s.accelerationV;
    Field& out = alongX ? *s.outU : *s.outV;
    const std::ptrdiff_t behind = alongX ? 1 : stride;
    for (int j = begin; j < end; ++j)
      for (int k = c.groupBegin[j]; k < c.groupBegin[j + 1]; ++k) {
        const Group& group = c.groups[k];
        const int i = group.i;
        const float *q = in.row(j) + i, *other = (alongX ? s.v : s.u)->row(j) + i, *phi = s.phi->row(j) + i;
        const auto mean = [](const float* a, const float* b) __attribute__((always_inline)) {
          return 0.5f * (load(a) + load(b));
        };
        // Through the four flux points.
        const Lanes left = alongX ? mean(q - 1, q) : mean(other - stride, other),
                    right = alongX ? mean(q, q + 1) : mean(other + 1 - stride, other + 1),
                    below = alongX ? mean(other - 1, other) : mean(q - stride, q),
                    above = alongX ? mean(other + stride - 1, other + stride) : mean(q, q + stride);
        const Lanes own = load(q);
        const auto term = [&](const Lanes& U, const float* p, std::ptrdiff_t step, int point)
            __attribute__((always_inline)) {
          return carriedBy(U, p, step, own,
                           {lanesOfBits(group.third[point]), lanesOfBits(group.fifth[point])}, kEven, kOdd);
        };
        const Lanes x = term(right, q, 1, 1) - term(left, q - 1, 1, 0);
        const Lanes y = term(above, q, stride, 3) - term(below, q - stride, stride, 2);
        const Lanes push = s.phiScale * (load(phi) - load(phi - behind));
        const Lanes impulse =
            (acceleration ? s.accelerationScale * load(acceleration->row(j) + i) : Lanes{}) - push;
        float* to = out.row(j) + i;
        store(to, select(lanesOfBits(group.faces), load(base.row(j) + i) + (impulse - s.rateScale * (x + y)),
                         load(to)));
      }
  }
}

}  // namespace smokebox

#include "rigid/spring_laws.h"

#include <algorithm>
#include <cmath>

#include "rigid/spring_row.h"

namespace smokebox {

namespace {
constexpr double kNoDistance = 1e-150;  // m
// (w h)^2 across its line at which a spring gets a row across.
constexpr double kSwings = 0.25;
}  // namespace

void SpringLaws::assign(int slots) {
  for (std::vector<double>* each : {&push, &perStretch, &perRate, &hardness, &squared})
    each->assign(slots, 0);
  length.assign(slots, 1);
}

void SpringLaws::set(int slot, const SpringDef& def, double inertia, double h) {
  const SpringShares shares = springShares(def.stiffness, def.damping, inertia, h);
  length[slot] = def.length;
  push[slot] = def.length - def.slack;
  perStretch[slot] = h * def.stiffness;
  perRate[slot] = h * (def.damping * (1 - shares.damping) - def.stiffness * shares.before * h);
  hardness[slot] = h * (def.stiffness * shares.now * h + def.damping * shares.damping);
  squared[slot] = h * h * def.stiffness * inertia;
}

/// In arrays, so that the roots and divisions run several at a time.
void SpringStretch::findRows(const SpringLaws& laws, int slot, int count, double h, double hBefore,
                             double mass, SpringMatrices& rows) {
  const double *rest = &laws.length[slot], *push = &laws.push[slot], *perStretch = &laws.perStretch[slot],
               *perRate = &laws.perRate[slot], *hardness = &laws.hardness[slot],
               *squared = &laws.squared[slot];
  float *xx = &rows.xx[slot], *xy = &rows.xy[slot], *yy = &rows.yy[slot];
  const double perSecond = 1 / hBefore, perMass = 1 / mass;
  double most = 0;
#pragma omp simd reduction(max : most)
  for (int k = 0; k < count; ++k) {
    const double distance = std::sqrt(x[k] * x[k] + y[k] * y[k]);
    const double inverse = 1 / (distance > kNoDistance ? distance : kNoDistance);
    const double pulled = distance - rest[k], pushed = distance - push[k];
    // Between the two lengths it is slack.
    const double stretch = (pulled > 0 ? pulled : 0) + (pushed < 0 ? pushed : 0);
    const double holds = pulled >= 0 || pushed <= 0 ? 1.0 : 0.0;
    const double ux = x[k] * inverse, uy = y[k] * inverse;
    const double bias =
        perStretch[k] * stretch + holds * perRate[k] * ((movedX[k] * ux + movedY[k] * uy) * perSecond);
    const double hard = holds * hardness[k] * perMass;
    x[k] = ux, y[k] = uy;
    stretch_[k] = stretch, inverse_[k] = inverse;
    const double across = squared[k] * stretch * inverse;
    across_[k] = across;
    most = most > across ? most : across;
    xx[k] = static_cast<float>(hard * ux * ux);
    xy[k] = static_cast<float>(hard * ux * uy);
    yy[k] = static_cast<float>(hard * uy * uy);
    biasX[k] = bias * ux;
    biasY[k] = bias * uy;
  }
  if (most > kSwings) stiffenAcross(slot, count, laws, h, perSecond, perMass, rows);
}

void SpringStretch::stiffenAcross(int slot, int count, const SpringLaws& laws, double h, double perSecond,
                                  double perMass, SpringMatrices& rows) {
  const double* perStretch = &laws.perStretch[slot];
  float *xx = &rows.xx[slot], *xy = &rows.xy[slot], *yy = &rows.yy[slot];
#pragma omp simd
  for (int k = 0; k < count; ++k) {
    const double weight = smoothStep((across_[k] - kSwings) * (4.0 / 3));
    const SpringShares shares = sharesOf(across_[k]);
    const double tight = weight * h * perStretch[k] * stretch_[k] * inverse_[k];
    const double hard = tight * shares.now * perMass;
    const double rate = (movedY[k] * x[k] - movedX[k] * y[k]) * perSecond;
    const double bias = -tight * shares.before * rate;
    xx[k] += static_cast<float>(hard * y[k] * y[k]);
    xy[k] -= static_cast<float>(hard * x[k] * y[k]);
    yy[k] += static_cast<float>(hard * x[k] * x[k]);
    biasX[k] -= bias * y[k];
    biasY[k] += bias * x[k];
  }
}

}  // namespace smokebox

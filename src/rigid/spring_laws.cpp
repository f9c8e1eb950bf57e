#include "rigid/spring_laws.h"

#include <algorithm>
#include <cmath>

#include "rigid/spring_row.h"

namespace smokebox {

namespace {

constexpr double kNoDistance = 1e-30;  // m^2
// (w h)^2 across its line at which a spring gets a row across.
constexpr double kSwings = 0.25;

}  // namespace

void SpringLaws::assign(int slots) {
  for (std::vector<float>* each : {&slack, &perStretch, &perRate, &hardness, &squared})
    each->assign(slots, 0);
  length.assign(slots, 1);
  rates = false;
}

void SpringLaws::set(int slot, const SpringDef& def, double inertia, double h) {
  const SpringShares shares = springShares(def.stiffness, def.damping, inertia, h);
  length[slot] = def.length;
  slack[slot] = static_cast<float>(def.slack);
  perStretch[slot] = static_cast<float>(h * def.stiffness);
  perRate[slot] =
      static_cast<float>(h * (def.damping * (1 - shares.damping) - def.stiffness * shares.before * h));
  hardness[slot] = static_cast<float>(h * (def.stiffness * shares.now * h + def.damping * shares.damping));
  squared[slot] = static_cast<float>(h * h * def.stiffness * inertia);
  rates = rates || perRate[slot] != 0;
}

/// In loops that do the same to every spring, so that they run many at a time. The stretch of a spring that
/// is all but at rest keeps seven digits of its own, for the squares are subtracted before any is lost.
void SpringRows::find(const SpringLaws& laws, int slot, int count, SpringMatrices& out) {
  const double* rest = &laws.length[slot];
  const float *slack = &laws.slack[slot], *perStretch = &laws.perStretch[slot],
              *hardness = &laws.hardness[slot], *squared = &laws.squared[slot];
  float *xx = &out.xx[slot], *xy = &out.xy[slot], *yy = &out.yy[slot];
  const SpringEnds at = place, speed = velocity;
  const auto perMass = static_cast<float>(1 / mass);
  float most = 0;
#pragma omp simd reduction(max : most)
  for (int k = 0; k < count; ++k) {
    const double dx = at.x(k), dy = at.y(k);
    const double square = dx * dx + dy * dy > kNoDistance ? dx * dx + dy * dy : kNoDistance;
    const auto excess = static_cast<float>(square - rest[k] * rest[k]), length = static_cast<float>(rest[k]);
    const float distance = std::sqrt(static_cast<float>(square)), inverse = 1 / distance;
    const float pulled = excess / (distance + length), pushed = pulled + slack[k];
    // Between the two lengths it is slack.
    const float stretch = (pulled > 0 ? pulled : 0) + (pushed < 0 ? pushed : 0);
    const float holds = pulled >= 0 || pushed <= 0 ? 1.0f : 0.0f;
    const float ux = static_cast<float>(dx) * inverse, uy = static_cast<float>(dy) * inverse;
    const float hard = holds * hardness[k];
    const float rate = static_cast<float>(speed.x(k)) * ux + static_cast<float>(speed.y(k)) * uy;
    const float pull = perStretch[k] * stretch + hard * rate;
    const float across = squared[k] * stretch * inverse;
    x[k] = ux, y[k] = uy;
    stretch_[k] = stretch, inverse_[k] = inverse, holds_[k] = holds, across_[k] = across;
    most = most > across ? most : across;
    pullX[k] = pull * ux;
    pullY[k] = pull * uy;
    const float unit = hard * perMass;
    xx[k] = unit * ux * ux;
    xy[k] = unit * ux * uy;
    yy[k] = unit * uy * uy;
  }
  if (laws.rates) addRates(laws, slot, count);
  if (most > kSwings) stiffenAcross(laws, slot, count, out);
}

void SpringRows::addRates(const SpringLaws& laws, int slot, int count) {
  const float* perRate = &laws.perRate[slot];
  const SpringEnds before = moved;
  const auto perSecond = static_cast<float>(1 / hBefore);
#pragma omp simd
  for (int k = 0; k < count; ++k) {
    const float rate =
        (static_cast<float>(before.x(k)) * x[k] + static_cast<float>(before.y(k)) * y[k]) * perSecond;
    const float pull = holds_[k] * perRate[k] * rate;
    pullX[k] += pull * x[k];
    pullY[k] += pull * y[k];
  }
}

void SpringRows::stiffenAcross(const SpringLaws& laws, int slot, int count, SpringMatrices& out) {
  const float* perStretch = &laws.perStretch[slot];
  float *xx = &out.xx[slot], *xy = &out.xy[slot], *yy = &out.yy[slot];
  const SpringEnds before = moved, speed = velocity;
  const double perSecond = 1 / hBefore, perMass = 1 / mass, step = h;
#pragma omp simd
  for (int k = 0; k < count; ++k) {
    const double ux = static_cast<double>(x[k]), uy = static_cast<double>(y[k]),
                 turning = static_cast<double>(across_[k]);
    const double weight = smoothStep((turning - kSwings) * (4.0 / 3));
    const SpringShares shares = sharesOf(turning);
    const double tight = weight * step * static_cast<double>(perStretch[k] * stretch_[k] * inverse_[k]);
    const double hard = tight * shares.now;
    const double rate = (before.y(k) * ux - before.x(k) * uy) * perSecond;
    const double pull = hard * (speed.y(k) * ux - speed.x(k) * uy) - tight * shares.before * rate;
    xx[k] += static_cast<float>(hard * perMass * uy * uy);
    xy[k] -= static_cast<float>(hard * perMass * ux * uy);
    yy[k] += static_cast<float>(hard * perMass * ux * ux);
    pullX[k] -= static_cast<float>(pull * uy);
    pullY[k] += static_cast<float>(pull * ux);
  }
}

}  // namespace smokebox

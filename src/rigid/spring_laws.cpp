#include "rigid/spring_laws.h"

#include <algorithm>
#include <cmath>

#include "rigid/spring_row.h"

namespace smokebox {

namespace {

constexpr double kNoDistance = 1e-30;  // m^2
// (w h)^2 across its line at which a spring gets a row across.
constexpr double kSwings = 0.25;

/// To 14 digits: from the root and quotient of seven digits, which are several times as fast, by a step of
/// Newton's.
inline double inverseRoot(double square) {
  const double about = static_cast<double>(1 / std::sqrt(static_cast<float>(square)));
  return about * (1.5 - 0.5 * square * about * about);
}

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

/// In loops that do the same to every spring, so that they run several at a time.
void SpringRows::find(const SpringLaws& laws, int slot, int count, SpringMatrices& out) {
  const double* rest = &laws.length[slot];
  const float *slack = &laws.slack[slot], *perStretch = &laws.perStretch[slot],
              *hardness = &laws.hardness[slot], *squared = &laws.squared[slot];
  float *xx = &out.xx[slot], *xy = &out.xy[slot], *yy = &out.yy[slot];
  const SpringEnds at = place, speed = velocity;
  const auto perMass = static_cast<float>(1 / mass);
  double most = 0;
#pragma omp simd reduction(max : most)
  for (int k = 0; k < count; ++k) {
    const double dx = at.x(k), dy = at.y(k);
    const double square = dx * dx + dy * dy > kNoDistance ? dx * dx + dy * dy : kNoDistance;
    const double inverse = inverseRoot(square);
    const double pulled = square * inverse - rest[k], pushed = pulled + static_cast<double>(slack[k]);
    // Between the two lengths it is slack.
    const double stretch = (pulled > 0 ? pulled : 0) + (pushed < 0 ? pushed : 0);
    const double holds = pulled >= 0 || pushed <= 0 ? 1.0 : 0.0;
    const double ux = dx * inverse, uy = dy * inverse;
    const double hard = holds * static_cast<double>(hardness[k]);
    const double pull =
        static_cast<double>(perStretch[k]) * stretch + hard * (speed.x(k) * ux + speed.y(k) * uy);
    const double across = static_cast<double>(squared[k]) * stretch * inverse;
    x[k] = ux, y[k] = uy;
    stretch_[k] = stretch, inverse_[k] = inverse, holds_[k] = holds, across_[k] = across;
    most = most > across ? most : across;
    pullX[k] = pull * ux;
    pullY[k] = pull * uy;
    const auto shortX = static_cast<float>(ux), shortY = static_cast<float>(uy);
    const float unit = static_cast<float>(hard) * perMass;
    xx[k] = unit * shortX * shortX;
    xy[k] = unit * shortX * shortY;
    yy[k] = unit * shortY * shortY;
  }
  if (laws.rates) addRates(laws, slot, count);
  if (most > kSwings) stiffenAcross(laws, slot, count, out);
}

void SpringRows::addRates(const SpringLaws& laws, int slot, int count) {
  const float* perRate = &laws.perRate[slot];
  const SpringEnds before = moved;
  const double perSecond = 1 / hBefore;
#pragma omp simd
  for (int k = 0; k < count; ++k) {
    const double rate = (before.x(k) * x[k] + before.y(k) * y[k]) * perSecond;
    const double pull = holds_[k] * static_cast<double>(perRate[k]) * rate;
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
    const double weight = smoothStep((across_[k] - kSwings) * (4.0 / 3));
    const SpringShares shares = sharesOf(across_[k]);
    const double tight = weight * step * static_cast<double>(perStretch[k]) * stretch_[k] * inverse_[k];
    const double hard = tight * shares.now;
    const double rate = (before.y(k) * x[k] - before.x(k) * y[k]) * perSecond;
    const double pull = hard * (speed.y(k) * x[k] - speed.x(k) * y[k]) - tight * shares.before * rate;
    xx[k] += static_cast<float>(hard * perMass * y[k] * y[k]);
    xy[k] -= static_cast<float>(hard * perMass * x[k] * y[k]);
    yy[k] += static_cast<float>(hard * perMass * x[k] * x[k]);
    pullX[k] -= pull * y[k];
    pullY[k] += pull * x[k];
  }
}

}  // namespace smokebox

// The solver of a sheet: conjugate gradients.
#include <algorithm>
#include <cmath>

#include "rigid/lanes.h"
#include "rigid/spring_sheet.h"

namespace smokebox {

namespace {

// In the first sweep of a sub-step, and in one that follows on contacts, which will push again anyway.
constexpr int kMostIterations = 40, kMostAgain = 10;
// It stops when the velocities that are still missing are this share of those that the springs make in a
// sub-step, or this share of a spring's length in a sub-step.
constexpr double kTolerance = 1e-3, kSmallest = 1e-10;

}  // namespace

/// The impulses that are missing for these velocities; the square of the velocities that they would make, by
/// mass, and in `made` that of those that the springs make in a sub-step.
double SpringSheet::residual(const Bodies& bodies, double& made) {
  // Against the warm start, for which the pulls are known.
  double *newX = made_.x(), *newY = made_.y();
  const double *velocityX = velocity_.x(), *velocityY = velocity_.y();
  const int count = static_cast<int>(body_.size()), nodes = bands_.nodes(), grain = bands_.grain();
  const double others = pool_->max(0, count, grain, 0, [&](int first, int last) {
    bool same = true;
    for (int k = first; k < last; ++k) {
      const Motion& v = bodies.velocity[body_[k]];
      newX[k] = v.x - velocityX[k], newY[k] = v.y - velocityY[k];
      same = same && newX[k] == 0 && newY[k] == 0;
    }
    return same ? 0 : 1;
  });
  if (others > 0)
    bands_.multiply(matrices_, nullptr, made_, rest_, *pool_);
  else
    bands_.makeField(rest_);
  double *restX = rest_.x(), *restY = rest_.y();
  const double *impulseX = impulse_.x(), *impulseY = impulse_.y(), *pullX = pulls_.x(), *pullY = pulls_.y(),
               *inverses = inverse_.data();
  made = 0;
  sums_.resize(beyond_.size());
  const double missing = pool_->sum(0, nodes, grain, [&](int first, int last) {
    Lanes without{}, springs{};
    for (int k = first; k < last; k += 4) {
      const Lanes ownX = load(impulseX + k), ownY = load(impulseY + k), inverse = load(inverses + k);
      const Lanes x = -(unit_ * load(restX + k) + ownX + load(pullX + k)),
                  y = -(unit_ * load(restY + k) + ownY + load(pullY + k));
      store(restX + k, x);
      store(restY + k, y);
      without += (x * x + y * y) * inverse;
      springs += (ownX * ownX + ownY * ownY) * inverse;
    }
    sums_[first / grain] = sumOf(springs);
    return sumOf(without);
  });
  for (const double sum : sums_) made += sum;
  return missing;
}

double SpringSheet::advance(float along) {
  float *missingX = missing_.x(), *missingY = missing_.y(), *changeX = change_.x(), *changeY = change_.y();
  const float *directionX = direction_.x(), *directionY = direction_.y(), *stepX = step_.x(),
              *stepY = step_.y(), *inverses = inverseShare_.data();
  return pool_->sum(0, bands_.nodes(), bands_.grain(), [&](int first, int last) {
    FloatLanes sum{};
    for (int k = first; k < last; k += kLanes) {
      store(changeX + k, load(changeX + k) + along * load(directionX + k));
      store(changeY + k, load(changeY + k) + along * load(directionY + k));
      const FloatLanes x = load(missingX + k) - along * load(stepX + k),
                       y = load(missingY + k) - along * load(stepY + k);
      store(missingX + k, x);
      store(missingY + k, y);
      sum += (x * x + y * y) * load(inverses + k);
    }
    return sumOf(sum);
  });
}

void SpringSheet::turn(float keep) {
  const float *missingX = missing_.x(), *missingY = missing_.y(), *inverses = inverseShare_.data();
  float *directionX = direction_.x(), *directionY = direction_.y();
  pool_->blocks(0, bands_.nodes(), bands_.grain(), [&](int first, int last) {
    for (int k = first; k < last; k += kLanes) {
      const FloatLanes inverse = load(inverses + k);
      store(directionX + k, inverse * load(missingX + k) + keep * load(directionX + k));
      store(directionY + k, inverse * load(missingY + k) + keep * load(directionY + k));
    }
  });
}

/// Of (shares of mass + matrices) change = missing, both in units of `scale` and the unit of mass, so that
/// all numbers are near 1. Returns the square that is left.
double SpringSheet::conjugateGradients(double left, double enough, double scale) {
  const double perImpulse = 1 / (unit_ * scale);
  const double *restX = rest_.x(), *restY = rest_.y();
  float *missingX = missing_.x(), *missingY = missing_.y();
#pragma omp simd
  for (int k = 0; k < bands_.nodes(); ++k) {
    missingX[k] = static_cast<float>(perImpulse * restX[k]);
    missingY[k] = static_cast<float>(perImpulse * restY[k]);
  }
  bands_.makeField(change_);
  bands_.makeField(direction_);
  turn(0);
  const int most = settled_ ? kMostAgain : kMostIterations;
  for (int iteration = 0; iteration < most && left > enough; ++iteration) {
    ++iterations_;
    const double along = left / bands_.multiply(matrices_, share_.data(), direction_, step_, *pool_);
    const double next = advance(static_cast<float>(along));
    turn(static_cast<float>(next / left));
    left = next;
  }
  return left;
}

double SpringSheet::solve(Bodies& bodies) {
  const int count = static_cast<int>(body_.size());
  double *leftX = left_.x(), *leftY = left_.y();
  if (settled_) {
    int k = 0;
    while (k < count && bodies.velocity[body_[k]].x == leftX[k] && bodies.velocity[body_[k]].y == leftY[k])
      ++k;
    if (k == count) return 0;
  }
  double made = 0;
  const double missing = residual(bodies, made);
  const double small = kSmallest * size_ / h_;
  const double enough = std::max(kTolerance * kTolerance * made, small * small * total_);
  if (!(missing > enough)) return 0;
  const double scale = std::sqrt(missing / total_), units = 1 / (unit_ * scale * scale);
  // Seven digits are not enough for the momentum of what is free, which changes by what is missing of it.
  double meanX = 0, meanY = 0;
  if (free_)
    for (int k = 0; k < count; ++k) meanX -= rest_.x()[k] / scale, meanY -= rest_.y()[k] / scale;
  const double still = conjugateGradients(units * missing, units * enough, scale);
  if (still > units * enough && !settled_) keepEnergy(bodies, scale);
  const float *changeX = change_.x(), *changeY = change_.y();
  if (free_) {
    for (int k = 0; k < count; ++k) meanX += mass_[k] * changeX[k], meanY += mass_[k] * changeY[k];
    meanX /= total_, meanY /= total_;
  }
  double *impulseX = impulse_.x(), *impulseY = impulse_.y();
  settled_ = true;
  return pool_->max(0, count, bands_.grain(), 0, [&](int first, int last) {
    double largest = 0;
    for (int k = first; k < last; ++k) {
      Motion& v = bodies.velocity[body_[k]];
      const double x = scale * (changeX[k] - meanX), y = scale * (changeY[k] - meanY);
      v.x += x;
      v.y += y;
      leftX[k] = v.x, leftY[k] = v.y;
      impulseX[k] += mass_[k] * x;
      impulseY[k] += mass_[k] * y;
      largest = std::max({largest, std::fabs(x), std::fabs(y)});
    }
    return largest;
  });
}

/// With v* the velocities without the springs, and g the residual: backward Euler takes energy away if g is
/// at right angles to v - v* and to v*. Both are brought about by adding a (v - v*) + b v*; what is free has
/// v* counted from its centre of mass.
void SpringSheet::keepEnergy(const Bodies& bodies, double scale) {
  const int count = static_cast<int>(body_.size());
  NodeField<double>& without = rest_;  // it has served
  double *madeX = made_.x(), *madeY = made_.y(), *withoutX = without.x(), *withoutY = without.y();
  const double *impulseX = impulse_.x(), *impulseY = impulse_.y();
  float *changeX = change_.x(), *changeY = change_.y();
  auto velocity = [&](int k) { return bodies.velocity[body_[k]]; };
  double meanX = 0, meanY = 0;
  if (free_) {
    for (int k = 0; k < count; ++k) {
      meanX += mass_[k] * velocity(k).x - impulseX[k];
      meanY += mass_[k] * velocity(k).y - impulseY[k];
    }
    meanX /= total_, meanY /= total_;
  }
  for (int k = 0; k < count; ++k) {
    const double x = inverse_[k] * impulseX[k], y = inverse_[k] * impulseY[k];
    madeX[k] = x + scale * changeX[k], madeY[k] = y + scale * changeY[k];
    const bool moves = inverse_[k] > 0;
    withoutX[k] = moves ? velocity(k).x - x - meanX : 0;
    withoutY[k] = moves ? velocity(k).y - y - meanY : 0;
  }
  auto dot = [&](const NodeField<double>& p, const NodeField<double>& q) {
    double sum = 0;
    for (int k = 0; k < count; ++k) sum += p.x()[k] * q.x()[k] + p.y()[k] * q.y()[k];
    return sum;
  };
  // What is still missing, along both.
  const double perUnit = 1 / unit_;
  double ra = 0, rb = 0;
  for (int k = 0; k < count; ++k) {
    const double x = scale * missing_.x()[k], y = scale * missing_.y()[k];
    ra += madeX[k] * x + madeY[k] * y;
    rb += withoutX[k] * x + withoutY[k] * y;
  }
  std::vector<double> share(mass_);
  for (double& each : share) each *= perUnit;
  const double aa = bands_.multiply(matrices_, share.data(), made_, product_, *pool_),
               ab = dot(without, product_);
  const double bb = bands_.multiply(matrices_, share.data(), without, product_, *pool_);
  const double determinant = aa * bb - ab * ab;
  if (!(determinant > 1e-12 * aa * bb)) return;
  const double a = (ra * bb - rb * ab) / determinant, b = (rb * aa - ra * ab) / determinant;
  for (int k = 0; k < count; ++k) {
    changeX[k] += static_cast<float>((a * madeX[k] + b * withoutX[k]) / scale);
    changeY[k] += static_cast<float>((a * madeY[k] + b * withoutY[k]) / scale);
  }
}

}  // namespace smokebox

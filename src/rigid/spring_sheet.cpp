#include "rigid/spring_sheet.h"

#include <algorithm>
#include <cmath>

namespace smokebox {

namespace {

constexpr int kMostIterations = 40, kBlock = 64;
constexpr double kNoDistance = 1e-150;  // m
// It stops when the velocities that are still missing are this share of those that the springs make in a
// sub-step, or this share of a spring's length in a sub-step.
constexpr double kTolerance = 1e-3, kSmallest = 1e-10;

}  // namespace

bool SpringSheet::takes(const Spring& spring, const Bodies& bodies) {
  auto atCentre = [&](const Anchor& end) {
    return end.body >= 0 && (end.at == Vec2{} || bodies.def[end.body].inertia == 0);
  };
  return atCentre(spring.def.from) && atCentre(spring.def.to);
}

void SpringSheet::layOut(const std::vector<int>& springs, const std::vector<Spring>& all,
                         const std::vector<SpringSheet>& before) {
  body_.clear();
  for (const int k : springs)
    for (const int body : {all[k].def.from.body, all[k].def.to.body}) body_.push_back(body);
  std::sort(body_.begin(), body_.end());
  body_.erase(std::unique(body_.begin(), body_.end()), body_.end());
  auto node = [&](int body) {
    return static_cast<int>(std::lower_bound(body_.begin(), body_.end(), body) - body_.begin());
  };
  links_.clear();
  double lengths = 0;
  for (const int k : springs) {
    Link link{};
    link.spring = k;
    link.a = node(all[k].def.from.body), link.b = node(all[k].def.to.body);
    lengths += all[k].def.length;
    links_.push_back(link);
  }
  size_ = springs.empty() ? 0 : lengths / static_cast<double>(springs.size());
  std::stable_sort(links_.begin(), links_.end(), [](const Link& p, const Link& q) { return p.a < q.a; });
  slotOf_.clear();
  for (int s = 0; s < static_cast<int>(links_.size()); ++s) slotOf_.push_back({links_[s].spring, s});
  std::sort(slotOf_.begin(), slotOf_.end());
  matrix_.assign(links_.size(), Matrix{});
  bias_.assign(links_.size(), Pair{0, 0});
  for (std::vector<double>* each : {&length_, &perStretch_, &perRate_, &hardness_, &squared_})
    each->assign(links_.size(), -1);  // a length unlike any: to be prepared
  nodeStart_.assign(1, 0);
  start_.clear(), end_.clear();
  for (int k = 0, s = 0; k < static_cast<int>(body_.size()); ++k) {
    for (; s < static_cast<int>(links_.size()) && links_[s].a == k; ++s)
      start_.push_back(k), end_.push_back(links_[s].b);
    nodeStart_.push_back(s);
  }

  const std::size_t count = body_.size();
  mass_.assign(count, 0), inverse_.assign(count, 0);
  for (std::vector<Pair>* each :
       {&place_, &moved_, &impulse_, &biases_, &velocity_, &rest_, &direction_, &product_, &change_})
    each->assign(count, Pair{0, 0});
  fresh_.assign(count, 1);
  for (const SpringSheet& sheet : before)
    for (std::size_t k = 0; k < sheet.body_.size(); ++k) {
      const int here = node(sheet.body_[k]);
      if (here == static_cast<int>(count) || body_[here] != sheet.body_[k]) continue;
      place_[here] = sheet.place_[k], impulse_[here] = sheet.impulse_[k];
      fresh_[here] = 0;
    }
}

void SpringSheet::mark(std::vector<int>& sheetOf, int number) const {
  for (const Link& link : links_) sheetOf[link.spring] = number;
}

void SpringSheet::prepare(int slot, const SpringDef& def, const Bodies& bodies, double h) {
  Link& link = links_[slot];
  link.stiffness = def.stiffness, link.damping = def.damping;
  link.inverseA = bodies.inverse[body_[link.a]].mass, link.inverseB = bodies.inverse[body_[link.b]].mass;
  const double inertia = link.inverseA + link.inverseB;
  const SpringShares shares = springShares(def.stiffness, def.damping, inertia, h);
  length_[slot] = def.length;
  hardness_[slot] = h * (def.stiffness * shares.now * h + def.damping * shares.damping);
  perStretch_[slot] = h * def.stiffness;
  perRate_[slot] = h * (def.damping * (1 - shares.damping) - def.stiffness * shares.before * h);
  squared_[slot] = h * h * def.stiffness * inertia;
}

void SpringSheet::beginStep(const std::vector<Spring>& springs, const Bodies& bodies, double h) {
  for (std::size_t s = 0; s < links_.size(); ++s) {
    const Link& link = links_[s];
    const SpringDef& def = springs[link.spring].def;
    if (h != h_ || def.length != length_[s] || def.stiffness != link.stiffness ||
        def.damping != link.damping || bodies.inverse[body_[link.a]].mass != link.inverseA ||
        bodies.inverse[body_[link.b]].mass != link.inverseB)
      prepare(static_cast<int>(s), def, bodies, h);
  }
  total_ = 0;
  free_ = true;
  for (std::size_t k = 0; k < body_.size(); ++k) {
    inverse_[k] = bodies.inverse[body_[k]].mass;
    mass_[k] = inverse_[k] > 0 ? 1 / inverse_[k] : 0;
    total_ += mass_[k];
    free_ = free_ && inverse_[k] > 0;
  }
  h_ = h;
}

void SpringSheet::warmStart(Bodies& bodies, double h, double hBefore) {
  for (std::size_t k = 0; k < body_.size(); ++k) {
    const Vec2 now = bodies.positionNow(body_[k]);
    const Pair place{now.x, now.y};
    Motion& v = bodies.velocity[body_[k]];
    moved_[k] = fresh_[k] ? hBefore * Pair{v.x, v.y} : place - place_[k];
    place_[k] = place;
    fresh_[k] = 0;
    biases_[k] = Pair{0, 0};
    v.x += inverse_[k] * impulse_[k][0];
    v.y += inverse_[k] * impulse_[k][1];
  }
  const int count = static_cast<int>(links_.size());
  for (int begin = 0; begin < count; begin += kBlock)
    findForces(begin, std::min(begin + kBlock, count), h, 1 / hBefore);
}

/// Gathered in blocks, so that the roots and divisions run several at a time.
void SpringSheet::findForces(int begin, int end, double h, double perSecond) {
  double x[kBlock], y[kBlock], beforeX[kBlock], beforeY[kBlock], bias[kBlock], across[kBlock];
  const int count = end - begin;
  for (int k = 0; k < count; ++k) {
    const int a = start_[begin + k], b = end_[begin + k];
    const Pair between = place_[b] - place_[a], before = moved_[b] - moved_[a];
    x[k] = between[0], y[k] = between[1];
    beforeX[k] = before[0], beforeY[k] = before[1];
  }
  const double *rest = &length_[begin], *perStretch = &perStretch_[begin], *perRate = &perRate_[begin],
               *squared = &squared_[begin];
#pragma omp simd
  for (int k = 0; k < count; ++k) {
    const double distance = std::sqrt(x[k] * x[k] + y[k] * y[k]);
    const double inverse = 1 / (distance > kNoDistance ? distance : kNoDistance);
    const double stretch = distance - rest[k];
    x[k] *= inverse;
    y[k] *= inverse;
    bias[k] = perStretch[k] * stretch + perRate[k] * ((beforeX[k] * x[k] + beforeY[k] * y[k]) * perSecond);
    across[k] = squared[k] * stretch * inverse;
  }
  for (int k = 0; k < count; ++k) {
    const int s = begin + k;
    const double hard = hardness_[s];
    matrix_[s] = {hard * x[k] * x[k], hard * x[k] * y[k], hard * y[k] * y[k]};
    bias_[s] = Pair{bias[k] * x[k], bias[k] * y[k]};
    if (across[k] > 0.25) stiffenAcross(s, h, perSecond);
    biases_[start_[s]] -= bias_[s];
    biases_[end_[s]] += bias_[s];
  }
}

/// The force's turning with the line, where the sub-step cannot follow it (spring_island.h).
void SpringSheet::stiffenAcross(int slot, double h, double perSecond) {
  const Link& link = links_[slot];
  const Pair between = place_[link.b] - place_[link.a], before = moved_[link.b] - moved_[link.a];
  const double distance = std::sqrt(between[0] * between[0] + between[1] * between[1]);
  const double inertia = link.inverseA + link.inverseB;
  if (!(distance > kNoDistance)) {
    // No line: as hard in all directions.
    matrix_[slot] = {hardness_[slot], 0, hardness_[slot]};
    bias_[slot] = Pair{0, 0};
    return;
  }
  const double x = between[0] / distance, y = between[1] / distance;
  const double tight = link.stiffness * (distance - length_[slot]) / distance;
  const SpringShares shares = springShares(tight, 0, inertia, h);
  const double weight = smoothStep((h * h * tight * inertia - 0.25) / 0.75);
  const double across = weight * tight * shares.now * h * h;
  const double rate = (before[1] * x - before[0] * y) * perSecond;
  const double bias = -weight * tight * shares.before * h * h * rate;
  matrix_[slot].xx += across * y * y;
  matrix_[slot].xy -= across * x * y;
  matrix_[slot].yy += across * x * x;
  bias_[slot] += Pair{-bias * y, bias * x};
}

inline SpringSheet::Pair SpringSheet::force(int slot, Pair rate) const {
  const Matrix& m = matrix_[slot];
  return Pair{m.xx, m.xy} * rate[0] + Pair{m.xy, m.yy} * rate[1];
}

/// out += J^T hardness J p; returns p . J^T hardness J p.
double SpringSheet::multiply(const std::vector<Pair>& p, std::vector<Pair>& out) const {
  Pair sum{0, 0};
  for (std::size_t a = 0; a < body_.size(); ++a) {
    const Pair here = p[a];
    Pair onA{0, 0};
    for (int s = nodeStart_[a]; s < nodeStart_[a + 1]; ++s) {
      const Pair d = p[end_[s]] - here, f = force(s, d);
      onA += f;
      out[end_[s]] += f;
      sum += f * d;
    }
    out[a] -= onA;
  }
  return sum[0] + sum[1];
}

double SpringSheet::solve(Bodies& bodies) {
  const std::size_t count = body_.size();
  for (std::size_t k = 0; k < count; ++k) {
    const Motion& v = bodies.velocity[body_[k]];
    velocity_[k] = Pair{v.x, v.y};
    rest_[k] = impulse_[k] + biases_[k];
    change_[k] = Pair{0, 0};
  }
  multiply(velocity_, rest_);
  Pair made{0, 0}, missing{0, 0}, own{0, 0};
  for (std::size_t k = 0; k < count; ++k) {
    rest_[k] = -rest_[k];
    const Pair z = inverse_[k] * rest_[k];
    direction_[k] = z;
    product_[k] = mass_[k] * z;
    missing += rest_[k] * z;
    own += product_[k] * z;
    made += impulse_[k] * impulse_[k] * inverse_[k];
  }
  double left = missing[0] + missing[1];
  const double small = kSmallest * size_ / h_;
  const double enough = std::max(kTolerance * kTolerance * (made[0] + made[1]), small * small * total_);
  if (!(left > enough)) return 0;
  for (int iteration = 0; iteration < kMostIterations && left > enough; ++iteration) {
    ++iterations_;
    const double along = left / (multiply(direction_, product_) + (own[0] + own[1]));
    missing = Pair{0, 0};
    for (std::size_t k = 0; k < count; ++k) {
      change_[k] += along * direction_[k];
      rest_[k] -= along * product_[k];
      missing += rest_[k] * rest_[k] * inverse_[k];
    }
    const double next = missing[0] + missing[1], keep = next / left;
    left = next;
    own = Pair{0, 0};
    for (std::size_t k = 0; k < count; ++k) {
      direction_[k] = inverse_[k] * rest_[k] + keep * direction_[k];
      product_[k] = mass_[k] * direction_[k];
      own += product_[k] * direction_[k];
    }
  }
  if (left > enough) keepEnergy();
  double largest = 0;
  for (std::size_t k = 0; k < count; ++k) {
    Motion& v = bodies.velocity[body_[k]];
    v.x += change_[k][0];
    v.y += change_[k][1];
    impulse_[k] += mass_[k] * change_[k];
    largest = std::max({largest, std::fabs(change_[k][0]), std::fabs(change_[k][1])});
  }
  return largest;
}

/// With v* the velocities without the springs, and g the residual: backward Euler takes energy away if g is
/// at right angles to v - v* and to v*. Both are brought about by adding a (v - v*) + b v*; what is free has
/// v* counted from its centre of mass.
void SpringSheet::keepEnergy() {
  const std::size_t count = body_.size();
  Pair mean{0, 0};
  if (free_) {
    for (std::size_t k = 0; k < count; ++k) mean += mass_[k] * velocity_[k] - impulse_[k];
    mean /= total_;
  }
  std::vector<Pair>&made = direction_, &without = velocity_;  // both have served
  for (std::size_t k = 0; k < count; ++k) {
    const Pair impulse = inverse_[k] * impulse_[k];
    made[k] = impulse + change_[k];
    without[k] = inverse_[k] > 0 ? velocity_[k] - impulse - mean : Pair{0, 0};
  }
  auto dot = [&](const std::vector<Pair>& p, const std::vector<Pair>& q) {
    Pair sum{0, 0};
    for (std::size_t k = 0; k < count; ++k) sum += p[k] * q[k];
    return sum[0] + sum[1];
  };
  for (std::size_t k = 0; k < count; ++k) product_[k] = mass_[k] * made[k];
  multiply(made, product_);
  const double aa = dot(made, product_), ab = dot(without, product_);
  for (std::size_t k = 0; k < count; ++k) product_[k] = mass_[k] * without[k];
  multiply(without, product_);
  const double bb = dot(without, product_), ra = dot(made, rest_), rb = dot(without, rest_);
  const double determinant = aa * bb - ab * ab;
  if (!(determinant > 1e-12 * aa * bb)) return;
  const double a = (ra * bb - rb * ab) / determinant, b = (rb * aa - ra * ab) / determinant;
  for (std::size_t k = 0; k < count; ++k) change_[k] += a * made[k] + b * without[k];
}

void SpringSheet::endStep(const Bodies& bodies, double h) {
  // What the impulses of the last sub-step were.
  for (std::size_t s = 0; s < links_.size(); ++s) {
    Link& link = links_[s];
    const Vec2 d = bodies.velocity[body_[link.b]].linear() - bodies.velocity[body_[link.a]].linear();
    const Pair f = bias_[s] + force(static_cast<int>(s), Pair{d.x, d.y});
    const Pair between = place_[link.b] - place_[link.a];
    const double distance = std::sqrt(between[0] * between[0] + between[1] * between[1]);
    link.tension = distance > 0 ? (f[0] * between[0] + f[1] * between[1]) / (distance * h) : 0;
  }
}

double SpringSheet::tension(int spring) const {
  const auto found = std::lower_bound(slotOf_.begin(), slotOf_.end(), std::array<int, 2>{spring, 0});
  return links_[(*found)[1]].tension;
}

std::size_t SpringSheet::bytes() const {
  return links_.size() * (sizeof(Link) + sizeof(Matrix) + sizeof(Pair) + sizeof(int) + 5 * sizeof(double)) +
         slotOf_.size() * 2 * sizeof(int) +
         body_.size() * (sizeof(int) + 2 * sizeof(double) + 8 * sizeof(Pair));
}

}  // namespace smokebox

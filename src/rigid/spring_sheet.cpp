#include "rigid/spring_sheet.h"

#include <algorithm>
#include <cmath>

namespace smokebox {

namespace {

constexpr int kMostIterations = 60;
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
                         const Bodies& bodies) {
  // What is known of nodes that stay.
  struct Known {
    int body;
    Pair place, moved, impulse;
  };
  std::vector<Known> known;
  for (std::size_t k = 0; k < body_.size(); ++k)
    known.push_back({body_[k], place_[k], moved_[k], impulse_[k]});

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
    link.length = -1;  // unlike any: to be prepared
    lengths += all[k].def.length;
    links_.push_back(link);
  }
  size_ = springs.empty() ? 0 : lengths / static_cast<double>(springs.size());
  std::stable_sort(links_.begin(), links_.end(), [](const Link& p, const Link& q) { return p.a < q.a; });
  slotOf_.assign(all.size(), -1);
  for (std::size_t s = 0; s < links_.size(); ++s) slotOf_[links_[s].spring] = static_cast<int>(s);
  forces_.assign(links_.size(), Force{});

  const std::size_t count = body_.size();
  mass_.assign(count, 0), inverse_.assign(count, 0);
  for (std::vector<Pair>* each :
       {&place_, &moved_, &impulse_, &velocity_, &rest_, &direction_, &product_, &change_})
    each->assign(count, Pair{0, 0});
  for (std::size_t k = 0; k < count; ++k) {
    const Motion& v = bodies.velocity[body_[k]];
    const Vec2 p = bodies.position[body_[k]];
    place_[k] = Pair{p.x, p.y};
    moved_[k] = Pair{v.x, v.y};  // times h, once that is known
    const auto old = std::lower_bound(known.begin(), known.end(), body_[k],
                                      [](const Known& each, int body) { return each.body < body; });
    if (old == known.end() || old->body != body_[k]) continue;
    place_[k] = old->place, moved_[k] = old->moved, impulse_[k] = old->impulse;
  }
}

int SpringSheet::slotOf(int spring) const {
  return spring < static_cast<int>(slotOf_.size()) ? slotOf_[spring] : -1;
}

void SpringSheet::prepare(Link& link, const SpringDef& def, const Bodies& bodies, double h) {
  link.length = def.length, link.stiffness = def.stiffness, link.damping = def.damping;
  link.inverseA = bodies.inverse[body_[link.a]].mass, link.inverseB = bodies.inverse[body_[link.b]].mass;
  const double inertia = link.inverseA + link.inverseB;
  const SpringShares shares = springShares(def.stiffness, def.damping, inertia, h);
  link.hardness = h * (def.stiffness * shares.now * h + def.damping * shares.damping);
  link.perStretch = h * def.stiffness;
  link.perRate = h * (def.damping * (1 - shares.damping) - def.stiffness * shares.before * h);
}

void SpringSheet::beginStep(const std::vector<Spring>& springs, const Bodies& bodies, double h) {
  for (Link& link : links_) {
    const SpringDef& def = springs[link.spring].def;
    if (h != h_ || def.length != link.length || def.stiffness != link.stiffness ||
        def.damping != link.damping || bodies.inverse[body_[link.a]].mass != link.inverseA ||
        bodies.inverse[body_[link.b]].mass != link.inverseB)
      prepare(link, def, bodies, h);
  }
  total_ = 0;
  for (std::size_t k = 0; k < body_.size(); ++k) {
    inverse_[k] = bodies.inverse[body_[k]].mass;
    mass_[k] = inverse_[k] > 0 ? 1 / inverse_[k] : 0;
    total_ += mass_[k];
  }
  h_ = h;
}

void SpringSheet::warmStart(Bodies& bodies, double h, double hBefore) {
  const double perSecond = 1 / hBefore;
  for (std::size_t k = 0; k < body_.size(); ++k) {
    const Vec2 now = bodies.positionNow(body_[k]);
    const Pair place{now.x, now.y};
    moved_[k] = started_ ? place - place_[k] : hBefore * moved_[k];
    place_[k] = place;
    Motion& v = bodies.velocity[body_[k]];
    v.x += inverse_[k] * impulse_[k][0];
    v.y += inverse_[k] * impulse_[k][1];
  }
  started_ = true;
  for (std::size_t s = 0; s < links_.size(); ++s) {
    const Link& link = links_[s];
    const Pair between = place_[link.b] - place_[link.a], before = moved_[link.b] - moved_[link.a];
    const double distance = std::sqrt(between[0] * between[0] + between[1] * between[1]);
    Force& force = forces_[s];
    if (!(distance > 0)) {
      // No line: as hard in all directions, and no force.
      force = {{Pair{link.hardness, 0}, Pair{0, link.hardness}}, Pair{0, 0}};
      continue;
    }
    const double x = between[0] / distance, y = between[1] / distance;
    const double stretch = distance - link.length;
    const double rate = (before[0] * x + before[1] * y) * perSecond;
    const double bias = link.perStretch * stretch + link.perRate * rate, hard = link.hardness;
    force.columns[0] = Pair{hard * x * x, hard * x * y};
    force.columns[1] = Pair{hard * x * y, hard * y * y};
    force.bias = Pair{bias * x, bias * y};
    // The force's turning with the line, where the sub-step cannot follow it (spring_island.h).
    const double tight = link.stiffness * stretch / distance, inertia = link.inverseA + link.inverseB;
    const double squared = h * h * tight * inertia;
    if (squared > 0.25) {
      const SpringShares shares = springShares(tight, 0, inertia, h);
      const double weight = smoothStep((squared - 0.25) / 0.75);
      const double across = weight * tight * shares.now * h * h;
      const double rateAcross = (before[1] * x - before[0] * y) * perSecond;
      const double biasAcross = -weight * tight * shares.before * h * h * rateAcross;
      force.columns[0] += Pair{across * y * y, -across * x * y};
      force.columns[1] += Pair{-across * x * y, across * x * x};
      force.bias += Pair{-biasAcross * y, biasAcross * x};
    }
  }
}

/// out = (M + J^T hardness J) p
void SpringSheet::multiply(const std::vector<Pair>& p, std::vector<Pair>& out) const {
  for (std::size_t k = 0; k < body_.size(); ++k) out[k] = mass_[k] * p[k];
  for (std::size_t s = 0; s < links_.size(); ++s) {
    const Link& link = links_[s];
    const Force& force = forces_[s];
    const Pair d = p[link.b] - p[link.a];
    const Pair f = force.columns[0] * d[0] + force.columns[1] * d[1];
    out[link.a] -= f;
    out[link.b] += f;
  }
}

double SpringSheet::solve(Bodies& bodies) {
  if (empty()) return 0;
  const std::size_t count = body_.size();
  Pair made{0, 0}, missing{0, 0};
  for (std::size_t k = 0; k < count; ++k) {
    const Motion& v = bodies.velocity[body_[k]];
    velocity_[k] = Pair{v.x, v.y};
    rest_[k] = -impulse_[k];
    change_[k] = Pair{0, 0};
  }
  for (std::size_t s = 0; s < links_.size(); ++s) {
    const Link& link = links_[s];
    const Force& force = forces_[s];
    const Pair d = velocity_[link.b] - velocity_[link.a];
    const Pair f = force.bias + force.columns[0] * d[0] + force.columns[1] * d[1];
    rest_[link.a] += f;
    rest_[link.b] -= f;
  }
  for (std::size_t k = 0; k < count; ++k) {
    const Pair z = inverse_[k] * rest_[k];
    direction_[k] = z;
    missing += rest_[k] * z;
    made += impulse_[k] * impulse_[k] * inverse_[k];
  }
  double left = missing[0] + missing[1];
  const double small = kSmallest * size_ / h_;
  const double enough = std::max(kTolerance * kTolerance * (made[0] + made[1]), small * small * total_);
  if (!(left > enough)) return 0;
  for (int iteration = 0; iteration < kMostIterations && left > enough; ++iteration) {
    ++iterations_;
    multiply(direction_, product_);
    Pair curvature{0, 0};
    for (std::size_t k = 0; k < count; ++k)
      curvature += direction_[k] * product_[k] * (inverse_[k] > 0 ? 1.0 : 0.0);
    const double along = left / (curvature[0] + curvature[1]);
    missing = Pair{0, 0};
    for (std::size_t k = 0; k < count; ++k) {
      change_[k] += along * direction_[k];
      rest_[k] -= along * product_[k];
      missing += rest_[k] * rest_[k] * inverse_[k];
    }
    const double next = missing[0] + missing[1], keep = next / left;
    left = next;
    for (std::size_t k = 0; k < count; ++k) direction_[k] = inverse_[k] * rest_[k] + keep * direction_[k];
  }
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

void SpringSheet::endStep(const Bodies& bodies, double h) {
  // What the impulses of the last sub-step were.
  for (std::size_t s = 0; s < links_.size(); ++s) {
    Link& link = links_[s];
    const Force& force = forces_[s];
    const Vec2 d = bodies.velocity[body_[link.b]].linear() - bodies.velocity[body_[link.a]].linear();
    const Pair f = force.bias + force.columns[0] * d.x + force.columns[1] * d.y;
    const Pair between = place_[link.b] - place_[link.a];
    const double distance = std::sqrt(between[0] * between[0] + between[1] * between[1]);
    link.tension = distance > 0 ? (f[0] * between[0] + f[1] * between[1]) / (distance * h) : 0;
  }
}

double SpringSheet::tension(int spring) const {
  const int slot = slotOf(spring);
  return slot < 0 ? 0 : links_[slot].tension;
}

std::size_t SpringSheet::bytes() const {
  return links_.size() * (sizeof(Link) + sizeof(Force)) + slotOf_.size() * sizeof(int) +
         body_.size() * (sizeof(int) + 2 * sizeof(double) + 8 * sizeof(Pair));
}

}  // namespace smokebox

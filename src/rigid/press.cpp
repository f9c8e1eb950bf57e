#include "rigid/press.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace smokebox {

namespace {
constexpr int kWalls = 4;  // the first bodies, which never come nearer
// A press squeezes out at so many times its speed at most: what a wedge of 14 degrees does.
constexpr double kOfSolid = 4;
// ... or at so much more than the fastest body there was; the second in m/s.
constexpr double kOfBodies = 1.25, kMore = 2;
// Sunk is what overlaps by more than this share of the thinner one's width.
constexpr double kSunk = 0.1;
// There is no room where more than this share of what is pressed is sunk.
constexpr double kNoRoom = 0.004;

double speedOf(const Bodies& bodies, int body) {
  const Motion& v = bodies.velocity[body];
  return std::max(length(v.linear()), std::abs(v.turn) * bodies.extent[body].turningReach());
}
}  // namespace

int Press::rootOf(int body) {
  while (parent_[body] != body) body = parent_[body] = parent_[parent_[body]];
  return body;
}

bool Press::begin(const Bodies& bodies) {
  isOn_ = false;
  hasRoom_ = true;
  most_.clear();
  bool any = !sunk_.empty();
  for (int b = kWalls; b < bodies.count() && !any; ++b)
    any = bodies.there[b] && !bodies.moves(b) && speedOf(bodies, b) > 0;
  if (!any) return false;
  parent_.resize(bodies.count());
  std::iota(parent_.begin(), parent_.end(), 0);
  rests_.clear();
  deep_.assign(bodies.count(), 0);
  return true;
}

void Press::add(const Bodies& bodies, const Contact& contact, double overlap) {
  if (overlap > kSunk * std::min(bodies.extent[contact.a].thinnest, bodies.extent[contact.b].thinnest))
    for (const int body : {contact.a, contact.b})
      deep_[body] = std::max(deep_[body], std::min(overlap, bodies.extent[body].thinnest));
  bool presses = false;
  for (int k = 0; k < contact.count; ++k) presses |= contact.points[k].impulseN > 0;
  if (!presses) return;
  const bool a = bodies.moves(contact.a), b = bodies.moves(contact.b);
  if (a && b) {
    const int ra = rootOf(contact.a), rb = rootOf(contact.b);
    parent_[std::max(ra, rb)] = std::min(ra, rb);
  } else if (a) {
    rests_.push_back({contact.a, contact.b, length(bodies.velocityAt(contact.b, contact.points[0].armB))});
  } else if (b) {
    rests_.push_back({contact.b, contact.a, length(bodies.velocityAt(contact.a, contact.points[0].armA))});
  }
}

void Press::end(const Bodies& bodies) {
  solid_.assign(bodies.count(), -1);
  driven_.assign(bodies.count(), 0);
  fastest_.assign(bodies.count(), 0);
  for (const Rest& rest : rests_) {
    const int root = rootOf(rest.body);
    int& solid = solid_[root];
    solid = solid == -1 || solid == rest.solid ? rest.solid : -2;
    driven_[root] = std::max(driven_[root], rest.speed);
  }
  for (int b = kWalls; b < bodies.count(); ++b) {
    if (!bodies.moves(b)) continue;
    double& fastest = fastest_[rootOf(b)];
    fastest = std::max(fastest, speedOf(bodies, b));
  }
  most_.assign(bodies.count(), std::numeric_limits<double>::infinity());
  for (int b = kWalls; b < bodies.count(); ++b) {
    const int root = bodies.moves(b) ? rootOf(b) : -1;
    if (root < 0 || solid_[root] != -2 || driven_[root] <= 0) continue;
    most_[b] = std::max(kOfSolid * driven_[root], kOfBodies * fastest_[root] + kMore);
  }
  int pressed = 0, sinking = 0;
  for (int b = 0; b < bodies.count(); ++b) {
    const bool isPressed = most_[b] < std::numeric_limits<double>::infinity();
    if (!isPressed && sunk(b) == 0) deep_[b] = 0;
    pressed += isPressed ? 1 : 0;
    sinking += deep_[b] > 0 ? 1 : 0;
  }
  sunk_.swap(deep_);
  if (sinking == 0) sunk_.clear();
  isOn_ = pressed + sinking > 0;
  hasRoom_ = sinking <= kNoRoom * pressed;
}

void Press::yield(Bodies& bodies) const {
  const int count = std::min(bodies.count(), static_cast<int>(most_.size()));
  for (int b = kWalls; b < count; ++b) {
    if (!bodies.moves(b)) continue;
    const double speed = speedOf(bodies, b);
    if (speed <= most_[b]) continue;
    Motion& v = bodies.velocity[b];
    const double keep = most_[b] / speed;
    v = {keep * v.x, keep * v.y, keep * v.turn, 0};
  }
}

}  // namespace smokebox

#include "world/rigid_stage.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "base/errors.h"

namespace smokebox {

void RigidStage::step(const SolidScripts& solids, long step, double dt) {
  releaseDue((static_cast<double>(step) + 1e-6) * dt);  // the slack of events, too
  for (int k = 0; k < solids.count(); ++k) {
    Solid& solid = solids_[k];
    solid.moves |= !solids.spec(k).motion.isStill();  // an event may have set one
    if (solid.moves) system_.moveTo(solid.id, solids.pose(k).position, solids.pose(k).angleRad);
  }
  const double end = static_cast<double>(step + 1) * dt;
  movePulls(static_cast<double>(step) * dt, end);
  try {
    system_.step(dt);
  } catch (const SimulationError&) {
    for (const Body& body : bodies_) {
      if (!isThere(body)) continue;
      const Vec2 p = system_.position(body.id), v = system_.velocity(body.id);
      if (!std::isfinite(p.x + p.y + v.x + v.y + system_.angleRad(body.id) + system_.spin(body.id)))
        throw SimulationError("the state of the body `" + body.spec.name + "` is not a finite number");
    }
    throw;
  }
  for (ClothMesh& cloth : cloths_) cloth.update(system_, dt);
  takeDeparted(end);
  if (inFluid_) placeInFluid(dt);
  keepPast(end, dt);
}

void RigidStage::releaseDue(double now) {
  std::erase_if(held_, [&](int index) {
    const Body& body = bodies_[index];
    if (!isThere(body)) return true;
    if (body.spec.heldUntil > now) return false;
    system_.release(body.id);
    return true;
  });
}

void RigidStage::movePulls(double start, double end) {
  std::erase_if(pulls_, [&](const Pull& pull) {
    if (!system_.springIsThere(pull.spring)) return true;  // its body is gone
    if (start + 1e-6 * dt_ < pull.until) {
      system_.moveSpringEnd(pull.spring, {pull.action.to[0](0, 0, end), pull.action.to[1](0, 0, end)});
      return false;
    }
    system_.removeSpring(pull.spring);
    return true;
  });
}

void RigidStage::takeDeparted(double time) {
  char when[40];
  std::snprintf(when, sizeof when, "t = %.4g s: ", time);
  bool any = false;
  for (const int id : system_.takeDeparted()) {
    any = true;
    if (system_.isThere(id)) system_.remove(id);
    const int index = id < static_cast<int>(ofSystem_.size()) ? ofSystem_[id] : -1;
    if (index < 0) continue;  // a particle of a cloth
    const BodySpec& spec = bodies_[index].spec;
    notices_.push_back(when + std::string(spec.particle ? "the particle `" : "the body `") + spec.name +
                       "` has left the domain for good");
  }
  for (std::size_t k = 0; any && k < cloths_.size(); ++k) {
    if (!clothIsThere_[k] || cloths_[k].isThere(system_)) continue;
    clothIsThere_[k] = 0;
    notices_.push_back(when + std::string("the cloth `") + cloths_[k].spec().name +
                       "` has left the domain for good");
  }
}

std::vector<std::string> RigidStage::takeNotices() { return std::exchange(notices_, {}); }

void RigidStage::placeInFluid(double dt) {
  const std::size_t before = moving_.size();
  posesBefore_.resize(bodies_.size(), Pose{{std::numeric_limits<double>::quiet_NaN(), 0}, 0});
  shapesMoved_ = false;
  std::size_t count = 0;
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    const Body& body = bodies_[k];
    if (body.spec.particle) continue;
    Pose& last = posesBefore_[k];
    if (!isThere(body)) {
      shapesMoved_ |= std::isfinite(last.position.x);
      last.position.x = std::numeric_limits<double>::quiet_NaN();
      continue;
    }
    const Pose now{system_.position(body.id), system_.angleRad(body.id)};
    const bool isNew = !std::isfinite(last.position.x);
    if (count == moving_.size()) moving_.emplace_back();
    MovingSolid& moving = moving_[count++];
    const bool moved = isNew || !(now == last);
    shapesMoved_ |= moved;
    if (moved || moving.origin != now.position || moving.outlines.size() != body.shape->outlines.size()) {
      moving.outlines.resize(body.shape->outlines.size());
      for (std::size_t m = 0; m < moving.outlines.size(); ++m)
        moving.outlines[m] = transformed(body.shape->outlines[m], now);
    }
    // As for a scripted solid: displacement over step, so that what it sweeps is what it pushes.
    Vec2 way = isNew ? Vec2{} : now.position - last.position;
    const auto unwrap = [](double d, double size) { return d - size * std::nearbyint(d / size); };
    if (walls_.sides[0] == RigidWalls::Kind::periodic) way.x = unwrap(way.x, walls_.width);
    if (walls_.sides[2] == RigidWalls::Kind::periodic) way.y = unwrap(way.y, walls_.height);
    moving.origin = now.position;
    moving.velocity = (1 / dt) * way;
    moving.spin = isNew ? 0 : (now.angleRad - last.angleRad) / dt;
    moving.drag = body.spec.drag;
    last = now;
  }
  shapesMoved_ |= count != before;
  moving_.resize(count);
}

void RigidStage::keepPast(double time, double dt) {
  if (touchSeconds_ > 0) {
    while (!impacts_.empty() && impacts_.front().time < time - touchSeconds_) impacts_.pop_front();
    std::erase_if(lastImpacts_, [&](const auto& last) {
      return last.second.time < time - touchSeconds_ - 0.5 * dt;  // the mark is gone
    });
    for (const Touch& touch : system_.touches())
      if (touch.approach > 0) keepImpact(touch, time);
  }
  const auto most = static_cast<std::size_t>(std::lround(trailSeconds_ / dt)) + 1;
  for (std::size_t k = 0; k < trails_.size(); ++k) {
    if (!isThere(bodies_[k])) {
      trails_[k].clear();
      continue;
    }
    trails_[k].push_back(system_.position(bodies_[k].id));
    if (trails_[k].size() > most) trails_[k].pop_front();
  }
}

/// Two that scrape along each other or rattle would leave a mark at every step, one upon another: a pair that
/// has one gets the next when that has faded, or for a blow that is much stronger.
void RigidStage::keepImpact(const Touch& touch, double time) {
  constexpr double kStronger = 3, kNear = 0.02;  // kNear: of the domain's height
  const LastImpact now{touch.impulse, time, touch.point};
  const auto [last, first] = lastImpacts_.try_emplace({touch.a, touch.b}, now);
  if (!first) {
    LastImpact& was = last->second;
    const bool sameStep = time - was.time < 0.5 * dt_;
    const bool elsewhere = sameStep && length(touch.point - was.point) > kNear * walls_.height;
    if (!elsewhere && touch.impulse < kStronger * was.impulse) return;
    was = now;
  }
  impacts_.push_back({touch, time});
}

}  // namespace smokebox

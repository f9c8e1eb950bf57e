// The figures of bodies, and what pictures show of them.
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/maths.h"
#include "world/rigid_stage.h"

namespace smokebox {

void RigidStage::record(StepFigures& figures) const {
  const RigidTotals totals = system_.totals();
  figures.momentum = figures.momentum + totals.momentum;
  figures.angularMomentum = totals.angularMomentum;
  figures.energyBodies = totals.kineticEnergy;
  figures.energyPotential = totals.potentialEnergy;
  // Two that have met and parted within the step have touched, too; touches of a pair follow each other.
  int pairs = 0;
  const std::vector<Touch>& touches = system_.touches();
  for (std::size_t k = 0; k < touches.size(); ++k)
    pairs += k == 0 || touches[k].a != touches[k - 1].a || touches[k].b != touches[k - 1].b;
  figures.contacts = std::max(totals.contacts, pairs);
  figures.overlap = totals.overlap;
  for (const Body& body : bodies_) {
    if (body.spec.particle || !isThere(body)) continue;
    BodyFigures record;
    record.name = body.spec.name;
    record.position = system_.position(body.id);
    record.angleDegrees = degrees(system_.angleRad(body.id));
    record.velocity = system_.velocity(body.id);
    record.spinDegrees = degrees(system_.spin(body.id));
    figures.bodies.push_back(std::move(record));
  }
}

std::optional<Carried> RigidStage::carried(const std::string& name) const {
  for (const Body& body : bodies_)
    if (body.spec.name == name && isThere(body))
      return Carried{{transformed(body.centre, body.spec.pose), body.spec.pose.angleRad},
                     {system_.position(body.id), system_.angleRad(body.id)}};
  return {};
}

void RigidStage::capture(double time, Snapshot& snapshot) const {
  snapshot.bodies.clear();
  snapshot.particles.clear();
  snapshot.springs.clear();
  snapshot.joints.clear();
  snapshot.cloths.clear();
  snapshot.touches.clear();
  snapshot.trails.clear();
  captureBodies(snapshot);
  captureLinks(snapshot);
  if (snapshot.shows(LayerKind::cloth))
    for (std::size_t k = 0; k < cloths_.size(); ++k) {
      if (!cloths_[k].shown || !cloths_[k].isThere(system_)) continue;
      ClothPicture sheet;
      cloths_[k].capture(system_, static_cast<int>(k), sheet);
      Vec2 low = sheet.positions[0], high = low;
      for (const Vec2 p : sheet.positions) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
      }
      for (const Vec2 shift : imagesOf(low, high)) {
        ClothPicture& image = snapshot.cloths.emplace_back(sheet);
        for (Vec2& p : image.positions) p = p + shift;
      }
    }
  if (snapshot.shows(LayerKind::collisions)) captureTouches(time, snapshot);
  if (snapshot.shows(LayerKind::trails)) captureTrails(snapshot);
}

std::vector<Vec2> RigidStage::imagesOf(Vec2 low, Vec2 high) const {
  const bool x = walls_.sides[0] == RigidWalls::Kind::periodic,
             y = walls_.sides[2] == RigidWalls::Kind::periodic;
  std::vector<Vec2> shifts{{}};
  if (x && low.x < 0) shifts.push_back({walls_.width, 0});
  if (x && high.x > walls_.width) shifts.push_back({-walls_.width, 0});
  const std::size_t along = shifts.size();
  for (std::size_t k = 0; y && k < along; ++k) {
    if (low.y < 0) shifts.push_back(shifts[k] + Vec2{0, walls_.height});
    if (high.y > walls_.height) shifts.push_back(shifts[k] - Vec2{0, walls_.height});
  }
  return shifts;
}

std::vector<Vec2> RigidStage::imagesBetween(Vec2 p, Vec2 q) const {
  return imagesOf({std::min(p.x, q.x), std::min(p.y, q.y)}, {std::max(p.x, q.x), std::max(p.y, q.y)});
}

void RigidStage::captureBodies(Snapshot& snapshot) const {
  const bool bodies = snapshot.shows(LayerKind::bodies), particles = snapshot.shows(LayerKind::particles);
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    const Body& body = bodies_[k];
    if (!(body.spec.particle ? particles : bodies) || !body.shown || !isThere(body)) continue;
    const Vec2 centre = system_.position(body.id);
    const double reach = body.shape->reach;
    const auto* circle = std::get_if<CircleShape>(body.spec.shape.get());
    const double radius = circle ? circle->radius : 0;
    for (const Vec2 shift : imagesOf(centre - Vec2{reach, reach}, centre + Vec2{reach, reach})) {
      const Pose pose{centre + shift, system_.angleRad(body.id)};
      if (body.spec.particle) {
        snapshot.particles.push_back({pose.position, radius, static_cast<int>(k), body.spec.color});
        continue;
      }
      BodyPicture picture{body.spec.name, static_cast<int>(k), {}, pose, body.spec.color, radius};
      for (const Outline& outline : body.shape->outlines)
        picture.outlines.push_back(transformed(outline, pose));
      snapshot.bodies.push_back(std::move(picture));
    }
  }
}

/// By the spring's law: the system knows only what has pulled during a step, and nothing of springs between
/// things that are held.
double RigidStage::tensionNow(const SpringDef& spring) const {
  const auto velocityAt = [&](const Anchor& anchor) {
    if (anchor.body < 0) return Vec2{};
    const Vec2 arm = system_.anchorPoint(anchor) - system_.position(anchor.body);
    return system_.velocity(anchor.body) + system_.spin(anchor.body) * perpendicular(arm);
  };
  const auto [from, to] = system_.endsOf(spring.from, spring.to);
  const double distance = length(to - from);
  const Vec2 along = distance > 0 ? (1 / distance) * (to - from) : Vec2{};
  const double rate = dot(velocityAt(spring.to) - velocityAt(spring.from), along);
  return spring.stiffness * (distance - spring.length) + spring.damping * rate;
}

void RigidStage::captureLinks(Snapshot& snapshot) const {
  snapshot.usualTension = usualTension_;
  if (snapshot.shows(LayerKind::springs)) {
    auto add = [&](int number, const std::optional<Color>& color, bool pull) {
      if (!system_.springIsThere(number)) return;
      const SpringDef& spring = system_.spring(number);
      const auto [from, to] = system_.endsOf(spring.from, spring.to);
      for (const Vec2 shift : imagesBetween(from, to))
        snapshot.springs.push_back(
            {from + shift, to + shift, tensionNow(spring), spring.length, color, pull});
    };
    for (std::size_t k = 0; k < springs_.size(); ++k) add(springs_[k], springColors_[k], false);
    for (const Pull& pull : pulls_) add(pull.spring, {}, true);
  }
  if (!snapshot.shows(LayerKind::joints)) return;
  for (const int number : joints_) {
    if (!system_.jointIsThere(number)) continue;
    const JointDef& joint = system_.joint(number);
    using Kind = JointSpec::Kind;
    const Kind kind = joint.kind == JointKind::pin     ? Kind::pin
                      : joint.kind == JointKind::weld  ? Kind::weld
                      : joint.kind == JointKind::slide ? Kind::slide
                                                       : Kind::rope;
    const auto [from, to] = system_.endsOf(joint.a, joint.b);
    const double turn = joint.a.body < 0 ? 0 : system_.angleRad(joint.a.body);
    for (const Vec2 shift : imagesBetween(from, to))
      snapshot.joints.push_back({kind, from + shift, to + shift, transformed(joint.axis, Pose{{}, turn}),
                                 joint.length, joint.lower, joint.upper,
                                 joint.motorLimit > 0 ? joint.motorSpeed : 0});
  }
}

void RigidStage::captureTouches(double time, Snapshot& snapshot) const {
  snapshot.usualImpulse = usualImpulse_;
  for (const KeptTouch& kept : impacts_)
    snapshot.touches.push_back(
        {kept.touch.point, kept.touch.normal, kept.touch.impulse, kept.touch.approach, time - kept.time});
  // What touches now; of a pair that rattles within the step its last blow, else its dot would flicker.
  const std::vector<Touch>& now = system_.touches();
  for (std::size_t k = 0; k < now.size(); ++k) {
    const bool again = k + 1 < now.size() && now[k].a == now[k + 1].a && now[k].b == now[k + 1].b;
    if (now[k].approach == 0 || !again)
      snapshot.touches.push_back({now[k].point, now[k].normal, now[k].impulse, 0, 0});
  }
}

void RigidStage::captureTrails(Snapshot& snapshot) const {
  for (std::size_t k = 0; k < trails_.size(); ++k) {
    if (trails_[k].empty() || !bodies_[k].shown) continue;
    TrailPicture trail;
    trail.index = static_cast<int>(k);
    trail.color = bodies_[k].spec.color;
    trail.seconds = dt_ * static_cast<double>(trails_[k].size() - 1);
    for (const Vec2 p : trails_[k]) {
      if (!trail.points.empty()) {
        const Vec2 way = p - trail.points.back();
        constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
        // It went out on one side and came in on the other.
        if (std::fabs(way.x) > walls_.width / 2 || std::fabs(way.y) > walls_.height / 2)
          trail.points.push_back({kNone, kNone});
      }
      trail.points.push_back(p);
    }
    snapshot.trails.push_back(std::move(trail));
  }
}

}  // namespace smokebox

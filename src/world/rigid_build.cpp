// How the system of bodies is built from a scene.
#include <algorithm>
#include <cmath>

#include "world/needs.h"
#include "world/rigid_stage.h"

namespace smokebox {

double wallSpeed(const DomainSpec& domain, int side) {
  const WallSpec& wall = domain.walls[side];
  return wall.kind == WallKind::noSlip ? wall.velocity[side < 2 ? 1 : 0](0, 0, 0) : 0;
}

namespace {

RigidWalls wallsOf(const DomainSpec& domain) {
  RigidWalls walls;
  walls.width = domain.grid.width();
  walls.height = domain.grid.height();
  for (int side = 0; side < 4; ++side) {
    const WallSpec& wall = domain.walls[side];
    using Kind = RigidWalls::Kind;
    walls.sides[side] = wall.kind == WallKind::open       ? Kind::open
                        : wall.kind == WallKind::periodic ? Kind::periodic
                                                          : Kind::closed;
    walls.speeds[side] = wallSpeed(domain, side);
  }
  return walls;
}

Vec2 turned(Vec2 v, double angleRad) { return transformed(v, Pose{{}, angleRad}); }

}  // namespace

RigidStage::RigidStage(const SceneSpec& spec, const SolidScripts& solids, double tolerance, bool inFluid,
                       ThreadPool& pool)
    : system_(wallsOf(spec.domain), spec.gravity, RigidMethod{}, pool),
      walls_(wallsOf(spec.domain)),
      inFluid_(inFluid),
      dt_(spec.time.step) {
  readGroups(spec);
  addSolids(spec, solids, tolerance);
  bodies_.resize(spec.bodies.size());
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    Body& body = bodies_[k];
    body.spec = spec.bodies[k];
    body.shape = shapeOf(body.spec.shape, tolerance, body.centre);
    if (!body.spec.later) addBody(body);
  }
  for (std::size_t k = 0; k < spec.cloths.size(); ++k) {
    const ClothSpec& cloth = spec.cloths[k];
    Vec2 centre;
    const auto particle =
        std::make_shared<const BodyShape>(makeBodyShape({CircleShape{cloth.radius}, {}}, tolerance, centre));
    const std::uint64_t own = std::uint64_t{1} << (groups_.size() + k);
    cloths_.emplace_back(cloth, particle, groupBits(cloth.ignore) | own, system_);
  }
  clothIsThere_.assign(cloths_.size(), 1);
  addLinks(spec);
  for (const LayerSpec& layer : spec.view.layers) {
    if (layer.kind == LayerKind::collisions && canShow(spec, layer.kind))
      touchSeconds_ = std::max(touchSeconds_, layer.fade);
    if (layer.kind == LayerKind::trails && canShow(spec, layer.kind))
      trailSeconds_ = std::max(trailSeconds_, layer.length);
  }
  usualImpulse_ = findUsualImpulse(spec.gravity);
  usualTension_ = findUsualTension(spec.gravity);
  trails_.resize(trailSeconds_ > 0 ? bodies_.size() : 0);
  if (inFluid_) placeInFluid(spec.time.step);
}

// --- building
// ---------------------------------------------------------------------------------------------------------

void RigidStage::readGroups(const SceneSpec& spec) {
  auto number = [&](const std::vector<std::string>& groups) {
    for (const std::string& group : groups) groups_.emplace(group, static_cast<int>(groups_.size()));
  };
  for (const BodySpec& body : spec.bodies) number(body.ignore);
  for (const ClothSpec& cloth : spec.cloths) number(cloth.ignore);
}

std::uint64_t RigidStage::groupBits(const std::vector<std::string>& groups) const {
  std::uint64_t bits = 0;
  for (const std::string& group : groups) bits |= std::uint64_t{1} << groups_.at(group);
  return bits;
}

void RigidStage::addSolids(const SceneSpec& spec, const SolidScripts& solids, double tolerance) {
  for (int k = 0; k < solids.count(); ++k) {
    BodyDef def;
    def.shape =
        std::make_shared<const BodyShape>(makeSolidShape({spec.solids[k].shape.shape, Pose{}}, tolerance));
    def.position = solids.pose(k).position;
    def.angleRad = solids.pose(k).angleRad;
    def.bounce = spec.solids[k].bounce;
    def.friction = spec.solids[k].friction;
    solids_.push_back({system_.add(def), solids.mass(k).centre, !spec.solids[k].motion.isStill()});
  }
}

std::shared_ptr<const BodyShape> RigidStage::shapeOf(const std::shared_ptr<const Shape>& shape,
                                                     double tolerance, Vec2& centre) {
  const auto [entry, isNew] = shapes_.try_emplace(shape.get());
  auto& [made, offset] = entry->second;
  if (isNew) made = std::make_shared<const BodyShape>(makeBodyShape({*shape, Pose{}}, tolerance, offset));
  centre = offset;
  return made;
}

double RigidStage::massOf(const Body& body) const {
  return body.spec.mass ? *body.spec.mass : body.spec.density * body.shape->mass.area;
}

/// The middle one of the masses, at the speed of a fall through an eighth of the height, or at that of the
/// fastest body at the start where nothing falls.
double RigidStage::findUsualImpulse(Vec2 gravity) const {
  std::vector<double> masses;
  double fastest = 0;
  for (const Body& body : bodies_) {
    masses.push_back(massOf(body));
    fastest = std::max(fastest, length(body.spec.velocity));
  }
  if (masses.empty()) return 1;
  const auto middle = masses.begin() + static_cast<std::ptrdiff_t>(masses.size() / 2);
  std::nth_element(masses.begin(), middle, masses.end());
  const double fall = 0.5 * std::sqrt(length(gravity) * walls_.height);
  const double speed = fall > 0 ? fall : fastest;
  return speed > 0 ? *middle * speed : *middle;
}

/// What a spring of this scene may carry: the weight that hangs on it, what it is stretched or pressed by at
/// the start, or what stops the bodies at its ends; the most of all springs, so that colours compare them.
double RigidStage::findUsualTension(Vec2 gravity) const {
  double usual = 0, tenth = 0;
  for (const int number : springs_) {
    const SpringDef& spring = system_.spring(number);
    const Vec2 from = system_.anchorPoint(spring.from), to = system_.anchorPoint(spring.to);
    double load = spring.stiffness * std::fabs(length(to - from) - spring.length);
    for (const int body : {spring.from.body, spring.to.body}) {
      if (body < 0) continue;
      const BodyDef& def = system_.def(body);
      const double speed = length(system_.velocity(body));
      load = std::max({load, def.mass * std::fabs(def.gravityScale) * length(gravity),
                       std::sqrt(spring.stiffness * def.mass) * speed});
    }
    usual = std::max(usual, load);
    tenth = std::max(tenth, 0.1 * spring.stiffness * spring.length);
  }
  return usual > 0 ? usual : tenth > 0 ? tenth : 1;
}

double RigidStage::inertiaOf(const Body& body) const {
  if (body.spec.particle) return 0;
  return massOf(body) * body.shape->mass.secondMoment / body.shape->mass.area;
}

void RigidStage::addBody(Body& body) {
  const BodySpec& spec = body.spec;
  BodyDef def;
  def.shape = body.shape;
  def.position = transformed(body.centre, spec.pose);
  def.angleRad = spec.pose.angleRad;
  def.velocity = spec.velocity;
  def.spin = spec.spinRad;
  def.mass = massOf(body);
  def.inertia = inertiaOf(body);
  def.bounce = spec.bounce;
  def.friction = spec.friction;
  def.linearDamping = spec.linearDamping;
  def.angularDamping = spec.angularDamping;
  def.gravityScale = spec.gravityScale;
  def.ignore = groupBits(spec.ignore);
  def.held = spec.heldUntil > 0;
  body.id = system_.add(def);
  const int index = static_cast<int>(&body - bodies_.data());
  if (def.held && spec.heldUntil < kForever) held_.push_back(index);
  if (static_cast<int>(ofSystem_.size()) <= body.id) ofSystem_.resize(body.id + 1, -1);
  ofSystem_[body.id] = index;
}

void RigidStage::addLinks(const SceneSpec& spec) {
  for (const SpringSpec& spring : spec.springs) {
    SpringDef def;
    def.from = *anchorOf(spring.from);
    def.to = *anchorOf(spring.to);
    def.length =
        spring.length ? *spring.length : length(system_.anchorPoint(def.to) - system_.anchorPoint(def.from));
    def.stiffness = spring.stiffness;
    def.damping = spring.damping;
    springs_.push_back(system_.addSpring(def));
    springColors_.push_back(spring.color);
  }
  for (const JointSpec& joint : spec.joints) {
    JointDef def;
    using Kind = JointSpec::Kind;
    def.kind = joint.kind == Kind::pin     ? JointKind::pin
               : joint.kind == Kind::weld  ? JointKind::weld
               : joint.kind == Kind::slide ? JointKind::slide
                                           : JointKind::rope;
    if (joint.kind == Kind::rope) {
      const Vec2 from = joint.from.value_or(centreNow(joint.a)), to = joint.to.value_or(centreNow(joint.b));
      def.a = anchorAt(joint.a, from);
      def.b = anchorAt(joint.b, to);
      def.length = joint.length.value_or(length(to - from));
    } else {
      const bool bMoves = joint.b.of == HoldSpec::Of::body || joint.b.of == HoldSpec::Of::cloth;
      const Vec2 at = joint.at.value_or(centreNow(bMoves ? joint.b : joint.a));
      def.a = anchorAt(joint.a, at);
      def.b = anchorAt(joint.b, at);
    }
    // The axis is given in the world's directions.
    def.axis = def.a.body < 0 ? joint.axis : turned(joint.axis, -system_.angleRad(def.a.body));
    def.lower = joint.limits[0];
    def.upper = joint.limits[1];
    def.motorSpeed = joint.motorSpeed;
    def.motorLimit = joint.motorLimit;
    joints_.push_back(system_.addJoint(def));
  }
}

std::optional<Anchor> RigidStage::anchorOf(const HoldSpec& hold) const {
  switch (hold.of) {
    case HoldSpec::Of::body: {
      const Body& body = bodies_[hold.index];
      if (!isThere(body)) return {};
      // A particle is a point.
      return Anchor{body.id, hold.at && !body.spec.particle ? *hold.at - body.centre : Vec2{}};
    }
    case HoldSpec::Of::solid:
      return Anchor{solids_[hold.index].id, hold.at.value_or(solids_[hold.index].centre)};
    case HoldSpec::Of::cloth: {
      const int id = cloths_[hold.index].body(hold.node);
      if (!system_.isThere(id)) return {};
      return Anchor{id, {}};
    }
    case HoldSpec::Of::world:
      break;
  }
  return Anchor{-1, hold.at.value_or(Vec2{})};
}

Anchor RigidStage::anchorAt(const HoldSpec& hold, Vec2 at) const {
  const Anchor anchor = *anchorOf(hold);
  if (anchor.body < 0) return {-1, at};
  return {anchor.body, turned(at - system_.position(anchor.body), -system_.angleRad(anchor.body))};
}

Vec2 RigidStage::centreNow(const HoldSpec& hold) const {
  HoldSpec middle = hold;
  middle.at.reset();
  return system_.anchorPoint(*anchorOf(middle));
}

}  // namespace smokebox

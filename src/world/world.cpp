#include "world/world.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/maths.h"
#include "scene/tree_path.h"
#include "world/ledger.h"
#include "world/needs.h"

namespace smokebox {

namespace {
// A polygon may miss a curve by this share of a cell: far below the error of the scheme at the surface.
constexpr double kOutlineTolerance = 1e-3;
}  // namespace

World::World(const SceneDocument& document, const Options& options)
    : document_(document),
      spec_(document.spec()),
      options_(options),
      pool_(options.threads),
      events_(spec_.events, spec_.time.step),
      solids_(spec_.solids, kOutlineTolerance * spec_.domain.grid.h),
      needs_(needsOf(spec_)),
      probes_(spec_.probes, kOutlineTolerance * spec_.domain.grid.h) {
  boundary_.grid = spec_.domain.grid;
  for (int s = 0; s < 4; ++s) boundary_.sides[s].kind = spec_.domain.walls[s].kind;
  if (needs_.rigid) {
    rigid_ = std::make_unique<RigidStage>(spec_, solids_, kOutlineTolerance * spec_.domain.grid.h,
                                          needs_.fluid, pool_);
    gatherCovered();
  }
  if (needs_.fluid) buildFluid();
  stepMs_.reserve(std::min(spec_.time.steps + 1, 1L << 20));
  if (options_.figures) recordFigures();
}

World::~World() = default;

void World::step() {
  const double dt = spec_.time.step;
  clock_.begin();
  fireEvents();
  clock_.stage("events");
  moveSolids();
  clock_.stage("scripts");
  if (rigid_) {
    moveBodies();
    clock_.stage("bodies");
  }
  if (fluid_) {
    coverGrid(solids_.shapesMoved() || (rigid_ && rigid_->shapesMoved()));
    clock_.stage("cover");
    if (smoke_) smoke_->emit(boundary_, time(), dt);
    if (needs_.parts.forced) addForces();
    clock_.stage("forces");
    fluid_->advect(boundary_, dt);
    clock_.stage("advect");
    if (needs_.parts.viscous) fluid_->diffuse(boundary_, spec_.fluid.viscosity, dt);
    if (needs_.parts.inviscidDrag && spec_.fluid.viscosity == 0) fluid_->applySurfaceDrag(boundary_);
    if (needs_.sourcesDrive) smoke_->driveFluid(boundary_, time(), *fluid_);
    clock_.stage("diffuse");
    projectFluid();
    clock_.stage("project");
    if (smoke_) smoke_->transport(boundary_, *fluid_, dt);
    clock_.stage("smoke");
    if (heat_) carryHeat();
    clock_.stage("heat");
  }
  ++stepCount_;
  if (options_.figures) recordFigures();
  clock_.stage("ledger");
  figures_.step = stepCount_;
  figures_.time = time();
  figures_.stageMs = clock_.stages();
  figures_.totalMs = clock_.totalMs();
  stepMs_.push_back(static_cast<float>(figures_.totalMs));
}

// --- building
// ---------------------------------------------------------------------------------------------------------

void World::buildFluid() {
  const Grid& grid = boundary_.grid;
  setWalls(0);
  onGrid_.cover(covered(), true, boundary_);
  fluid_.emplace(boundary_, needs_.parts, pool_);
  if (needs_.smoke) smoke_.emplace(spec_, boundary_, kOutlineTolerance * grid.h, pool_);
  if (needs_.heat) heat_.emplace(spec_, boundary_, needs_.heatDiffuses, pool_);

  const auto& start = spec_.fluid.velocity;
  for (int j = 0; j <= grid.ny; ++j)
    for (int i = 0; i <= grid.nx; ++i) {
      const Vec2 x = grid.xFaceCentre(i, j), y = grid.yFaceCentre(i, j);
      if (j < grid.ny)
        fluid_->u()(i, j) =
            boundary_.openX(i, j) > 0 ? static_cast<float>(start[0](x.x, x.y, 0)) : boundary_.wallU(i, j);
      if (i < grid.nx)
        fluid_->v()(i, j) =
            boundary_.openY(i, j) > 0 ? static_cast<float>(start[1](y.x, y.y, 0)) : boundary_.wallV(i, j);
    }
  projectFluid();
  fluid_->forgetPressure();  // that of the start is an impulse without a duration
}

void World::setWalls(double time) {
  const Grid& grid = boundary_.grid;
  wallsDependOnTime_ = false;
  for (int s = 0; s < 4; ++s) {
    const bool vertical = s < 2;  // left and right
    const WallSpec& wall = spec_.domain.walls[s];
    wallsDependOnTime_ |= wall.velocity[0].dependsOnTime() || wall.velocity[1].dependsOnTime();
    SideFlow& side = boundary_.sides[s];
    const int faces = vertical ? grid.ny : grid.nx;
    side.u.resize(faces);
    side.v.resize(faces);
    for (int k = 0; k < faces; ++k) {
      const double along = (k + 0.5) * grid.h;
      const Vec2 at =
          vertical ? Vec2{s == 0 ? 0 : grid.width(), along} : Vec2{along, s == 2 ? 0 : grid.height()};
      const Vec2 half = 0.5 * grid.h * (vertical ? Vec2{0, 1} : Vec2{1, 0});
      side.u[k] = static_cast<float>(wall.mean(0, at, half, time));
      side.v[k] = static_cast<float>(wall.mean(1, at, half, time));
    }
  }
}

// --- events
// -----------------------------------------------------------------------------------------------------------

void World::fireEvents() {
  std::erase_if(forces_, [&](const ActiveForce& force) { return stepCount_ >= force.untilStep; });
  std::erase_if(captions_, [&](const ActiveCaption& caption) { return time() >= caption.until; });
  for (const int index : events_.due(stepCount_)) {
    const auto& action = spec_.events[index].action;
    if (const auto* set = std::get_if<SetAction>(&action)) {
      adoptSettings(SetAction(*set));  // a copy: the scene that holds it is replaced
    } else if (const auto* burst = std::get_if<BurstAction>(&action)) {
      if (smoke_) smoke_->burst(boundary_, *burst);
    } else if (const auto* force = std::get_if<ForceAction>(&action)) {
      if (!fluid_) continue;
      const Grid& grid = boundary_.grid;
      const long steps = std::max(1L, std::lround(force->duration / spec_.time.step));
      ActiveForce made{Field(grid.nx, grid.ny), force->acceleration, stepCount_ + steps};
      coverShare(grid, outlinesOf(force->shape, kOutlineTolerance * grid.h), made.share);
      fillRim(boundary_, made.share);
      forces_.push_back(std::move(made));
    } else if (const auto* visibility = std::get_if<VisibilityAction>(&action)) {
      const int solid = solids_.find(visibility->name);
      if (solid >= 0) solids_.setShown(solid, visibility->visible);
      if (rigid_) rigid_->setShown(visibility->name, visibility->visible);
    } else if (const auto* stop = std::get_if<StopAction>(&action)) {
      solids_.stop(solids_.find(stop->solid));
    } else if (const auto* caption = std::get_if<CaptionAction>(&action)) {
      captions_.push_back({caption->text, time() + caption->duration});
    } else if (rigid_) {
      fireRigid(spec_.events[index], index);
    }
  }
}

void World::fireRigid(const EventSpec& event, int index) {
  if (const auto* impulse = std::get_if<ImpulseAction>(&event.action))
    rigid_->impulse(*impulse);
  else if (const auto* pull = std::get_if<PullAction>(&event.action))
    rigid_->pull(*pull, time());
  else if (const auto* hold = std::get_if<HoldAction>(&event.action))
    rigid_->hold(*hold);
  else if (const auto* remove = std::get_if<RemoveAction>(&event.action))
    rigid_->remove(*remove);
  else if (const auto* add = std::get_if<AddAction>(&event.action))
    rigid_->add(*add, index);
  else if (const auto* cut = std::get_if<CutAction>(&event.action))
    rigid_->cut(*cut);
}

void World::adoptSettings(const SetAction& action) {
  document_.set(action.path, action.value, action.place);
  spec_ = document_.spec();
  if (pathSteps(action.path)[0] == "view") return;  // pictures only
  solids_.adopt(spec_.solids);
  for (int k = 0; k < solids_.count(); ++k) {
    const std::string byName = "solids." + spec_.solids[k].name, byIndex = "solids." + std::to_string(k);
    if (action.path.starts_with(byName + ".motion") || action.path.starts_with(byIndex + ".motion"))
      solids_.motionReplaced(k, time());
  }
  if (rigid_) rigid_->adopt(spec_, action.path);
  if (!fluid_) return;
  if (smoke_ && concerns(action.path, "smoke.sources")) smoke_->placeSources(spec_, boundary_);
  setWalls(time() + spec_.time.step);
  if (heat_ && concerns(action.path, "temperature.walls")) heat_->setSides(spec_, boundary_, time());
  onGrid_.cover(covered(), false, boundary_);
}

void World::moveSolids() {
  solids_.move(time(), spec_.time.step);
  for (int k = 0; solids_.shapesMoved() && k < solids_.count(); ++k) {
    const Pose& pose = solids_.pose(k);
    if (!std::isfinite(pose.position.x) || !std::isfinite(pose.position.y) || !std::isfinite(pose.angleRad))
      fail("the motion of the solid `" + solids_.spec(k).name + "` is not a finite number",
           "try another expression, such as one without a division by 0");
  }
}

void World::moveBodies() {
  try {
    rigid_->step(solids_, stepCount_, spec_.time.step);
  } catch (const SimulationError& error) {
    fail(error.what(), "try a smaller time.step, or a smaller stiffness or force");
  }
  gatherCovered();
}

void World::gatherCovered() {
  if (!needs_.fluid) return;
  const std::vector<MovingSolid>&solids = solids_.moving(), &bodies = rigid_->moving();
  covered_.resize(solids.size() + bodies.size());
  std::copy(solids.begin(), solids.end(), covered_.begin());
  std::copy(bodies.begin(), bodies.end(), covered_.begin() + static_cast<std::ptrdiff_t>(solids.size()));
}

std::optional<Carried> World::carried(const std::string& name) const {
  const int solid = solids_.find(name);
  if (solid >= 0) return Carried{solids_.startPose(solid), solids_.pose(solid)};
  return rigid_ ? rigid_->carried(name) : std::nullopt;
}

std::vector<std::string> World::takeNotices() {
  return rigid_ ? rigid_->takeNotices() : std::vector<std::string>();
}

// --- the fluid's stages
// -----------------------------------------------------------------------------------------------

void World::coverGrid(bool shapesMoved) {
  if (wallsDependOnTime_) setWalls(time() + spec_.time.step);
  if (!shapesMoved && !solidsMovedBefore_ && !wallsDependOnTime_) return;
  if (shapesMoved) fluid_->prepareUncovering(boundary_);
  onGrid_.cover(covered(), shapesMoved, boundary_);
  if (shapesMoved) fluid_->boundaryChanged(boundary_);
  if (shapesMoved && heat_) heat_->boundaryChanged(boundary_);
  solidsMovedBefore_ = shapesMoved;  // one more time after the last move, for the velocities to become 0
}

void World::addForces() {
  const Grid& grid = boundary_.grid;
  fluid_->beginForces(boundary_, spec_.fluid.vorticity, std::min(grid.width(), grid.height()) / 256);
  if (smoke_ && spec_.smoke.buoyancy != 0)
    smoke_->addBuoyancy(boundary_, spec_.smoke.buoyancy, spec_.gravity, fluid_->accelerationU(),
                        fluid_->accelerationV());
  if (heat_ && needs_.heatRises)
    heat_->addBuoyancy(spec_, boundary_, fluid_->accelerationU(), fluid_->accelerationV());
  for (const ActiveForce& force : forces_) {
    const auto ax = static_cast<float>(0.5 * force.acceleration.x),
               ay = static_cast<float>(0.5 * force.acceleration.y);
    for (int j = 0; j <= grid.ny; ++j)
      for (int i = 0; i <= grid.nx; ++i) {
        if (boundary_.openX(i, j) > 0)
          fluid_->accelerationU()(i, j) += ax * (force.share(i - 1, j) + force.share(i, j));
        if (boundary_.openY(i, j) > 0)
          fluid_->accelerationV()(i, j) += ay * (force.share(i, j - 1) + force.share(i, j));
      }
  }
}

void World::projectFluid() {
  const MethodSpec& method = spec_.method;
  const PressureSolver::Result result =
      fluid_->project(boundary_, spec_.time.step, method.tolerance, method.maxIterations);
  figures_.iterations = result.iterations;
  figures_.divergence = result.divergence;
  figures_.compression = result.compression;
  divergenceMax_ = std::max(divergenceMax_, result.divergence);
  if (!std::isfinite(result.divergence))
    fail("the velocity is not a number " + whereNotFinite(*fluid_, boundary_.grid),
         "try a smaller time.step, or a smaller force, buoyancy or fluid.vorticity");
  if (!result.converged) {
    char text[160];
    std::snprintf(text, sizeof text,
                  "the pressure did not converge: divergence %.2g after %d iterations, wanted %.2g",
                  result.divergence, result.iterations, method.tolerance);
    fail(text, "try a smaller time.step, a larger method.max_iterations or a larger method.tolerance");
  }
}

void World::carryHeat() {
  if (heat_->sidesDependOnTime()) heat_->setSides(spec_, boundary_, time() + spec_.time.step);
  const Heat::Result result =
      heat_->transport(boundary_, *fluid_, spec_.temperature.diffusivity, spec_.time.step);
  if (!result.finite) fail("the temperature is not a number", "try a smaller time.step");
  if (!result.converged)
    fail("the diffusion of heat did not converge",
         "try a smaller time.step or a smaller temperature.diffusivity");
}

void World::fail(const std::string& what, const std::string& hint) const {
  char place[64];
  std::snprintf(place, sizeof place, "step %ld (t = %.4g s): ", stepCount_ + 1, time() + spec_.time.step);
  throw SimulationError(place + what + " (" + hint + ")");
}

}  // namespace smokebox

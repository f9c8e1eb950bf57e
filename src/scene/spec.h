// A scene as plain data: what the file says, checked, with defaults filled in. Section 3 of the design is the
// contract. SI units, y up; angles in radians here (degrees in files).
#pragma once
#include <array>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/color.h"
#include "base/errors.h"
#include "geometry/grid.h"
#include "geometry/shape.h"
#include "geometry/walls.h"
#include "scene/expression.h"
#include "scene/motion.h"
#include "scene/name_table.h"
#include "scene/rigid_spec.h"

namespace smokebox {

struct WallSpec {
  WallKind kind = WallKind::slip;
  /// inflow: velocity of the fluid as functions of x, y, t; no-slip: velocity of the wall (constant
  /// expressions).
  std::array<Expression, 2> velocity;

  /// Mean of a component of the velocity from middle - half to middle + half: by Gauss' rule, so that what
  /// flows through a face is exact for a parabola, and two profiles that balance do so at any resolution.
  double mean(int component, Vec2 middle, Vec2 half, double t) const {
    constexpr double kGauss = 0.57735026918962576;  // 1 / sqrt(3)
    const Vec2 a = middle - kGauss * half, b = middle + kGauss * half;
    return 0.5 * (velocity[component](a.x, a.y, t) + velocity[component](b.x, b.y, t));
  }
};

struct DomainSpec {
  Grid grid;
  std::array<WallSpec, 4> walls;  // indexed by Side
  const WallSpec& wall(Side side) const { return walls[static_cast<int>(side)]; }
};

struct TimeSpec {
  double step = 1.0 / 120;  // s
  double duration = 10;     // s
  long steps = 1200;        // duration / step, whole
  int stepsPerFrame = 4;    // whole: 1 / (fps step)
};

struct FluidSpec {
  double density = 1.2;                // kg/m^3 (per metre of depth)
  double viscosity = 0;                // kinematic, m^2/s
  double vorticity = 0;                // strength of the confinement, dimensionless
  std::array<Expression, 2> velocity;  // at the start, of x and y
};

struct SourceSpec {
  PlacedShape shape;
  double rate = 1;               // smoke value per second inside the shape
  std::optional<Vec2> velocity;  // the fluid inside is driven at this velocity, m/s
  Color color;
  double from = 0, until = kForever;  // s
};

struct SmokeSpec {
  double buoyancy = 0;  // upward (against gravity; +y without gravity) acceleration per unit of smoke, m/s^2
  std::vector<SourceSpec> sources;
};

struct TemperatureSpec {
  bool named = false;         // no temperature is modelled otherwise
  double diffusivity = 0;     // m^2/s
  double expansion = 3.4e-3;  // share of the volume that a degree adds, 1/K; that of air
  Expression start;           // of x and y
  std::optional<double>
      reference;  // at which the fluid neither rises nor sinks; default: the mean of the start
  /// Indexed by Side, of x, y and t: what a closed wall keeps, or what the fluid brings that comes in;
  /// without it a wall is insulated, and fluid comes in as it was there at the start.
  std::array<std::optional<Expression>, 4> walls;
};

struct SolidSpec {
  std::string name;
  PlacedShape shape;    // pose at rest: what `position` and `angle` say (zero for world coordinates)
  MotionScript motion;  // absolute pose of the shape's (0, 0) as a function of time
  double drag = 0;      // 0 full slip .. 1 no slip; the default follows the viscosity
  double bounce = 0, friction = 0.5;
  std::optional<Color> color;
  bool report = false;  // force and torque in the figures
};

struct ProbeSpec {
  std::string name;
  std::optional<Vec2> at;             // a point ...
  std::optional<PlacedShape> region;  // ... or a region, in world coordinates at the start
  std::string follow;                 // the solid or body that it moves rigidly with; empty: stands still
};

// --- events
// ---------------------------------------------------------------------------------------------------------
struct SetAction {
  std::string path, value;
  SourcePlace place;
};  // YAML text of the value
struct BurstAction {
  PlacedShape shape;
  double smoke = 1;
  Color color;
};
struct ForceAction {
  PlacedShape shape;
  Vec2 acceleration;
  double duration = 0;
};  // 0: one step
struct VisibilityAction {
  std::string name;  // of a solid, body, particle or cloth
  bool visible = true;
};  // pictures only
struct StopAction {
  std::string solid;
};  // stays where it is from then on
struct CaptionAction {
  std::string text;
  double duration = kForever;
};

struct EventSpec {
  double first = 0, every = 0, until = kForever;  // every = 0: once
  std::variant<SetAction, BurstAction, ForceAction, VisibilityAction, StopAction, CaptionAction,
               ImpulseAction, PullAction, HoldAction, RemoveAction, AddAction, CutAction>
      action;
};

// --- pictures
// -------------------------------------------------------------------------------------------------------
enum class LayerKind {
  smoke,
  solids,
  pressure,
  vorticity,
  speed,
  temperature,
  velocity,
  caption,
  time,
  probes,
  bodies,
  particles,
  springs,
  joints,
  cloth,
  trails,
  collisions
};

/// As a scene calls it.
const char* layerName(LayerKind kind);

struct LayerSpec {
  LayerKind kind = LayerKind::smoke;
  bool shown = true;  // false: not until an event shows it
  double opacity = 1;
  std::optional<std::array<double, 2>>
      range;                   // of a field; without it one range for the whole film is found. Of springs: N
  bool bar = true;             // colour bar of a field
  double spacing = 0;          // velocity arrows: metres between them; 0: chosen
  double scale = 0;            // velocity arrows: seconds of motion that an arrow shows; 0: chosen
  std::optional<Color> color;  // arrows, time stamp, caption
  bool mark = true;            // bodies: a spoke shows how they turn
  double length = 1;           // trails: seconds that they go back
  double fade = 0.25;          // collisions: seconds that they stay
  bool atTop = false;          // captions: at the upper edge
};

struct CaptionSpec {
  double from = 0, until = kForever;
  std::string text;
};

struct CameraSpec {
  std::optional<Vec2> center;    // default: the domain's middle
  std::optional<double> height;  // metres seen vertically; default: all of the domain fits
  std::string follow;            // a solid or body: the centre is relative to its position (default (0, 0))
};

struct ViewSpec {
  std::vector<LayerSpec> layers;
  std::vector<std::string> layerNames;  // of all that are listed
  std::vector<CaptionSpec> captions;
  Color background{0.055f, 0.063f, 0.078f};
  CameraSpec camera;
};

struct OutputSpec {
  int width = 1280, height = 720;
  int fps = 30;
};

struct MethodSpec {
  double tolerance =
      1e-5;  // divergence at which the pressure solve stops (0 < tolerance < 1); see the design
  int maxIterations = 200;
};

struct SceneSpec {
  std::string name;   // of the file, without folder and ending
  std::string title;  // may be empty
  DomainSpec domain;
  TimeSpec time;
  Vec2 gravity;
  bool hasFluid =
      false;  // fluid, smoke, temperature or an inflow is named: without one of them no fluid is built
  FluidSpec fluid;
  SmokeSpec smoke;
  TemperatureSpec temperature;
  std::vector<SolidSpec> solids;
  std::vector<BodySpec> bodies;  // particles too; at the end those that events add
  std::vector<SpringSpec> springs;
  std::vector<JointSpec> joints;
  std::vector<ClothSpec> cloths;
  NameTable names;  // of solids, bodies (of all copies, and of each) and cloths
  std::vector<EventSpec> events;
  std::vector<ProbeSpec> probes;
  ViewSpec view;
  OutputSpec output;
  MethodSpec method;

  /// Colours of sources that events set later on.
  std::vector<Color> laterSmokeColors;

  /// All colours of smoke that can ever appear (sources and bursts), each once, in the order of the file.
  std::vector<Color> smokeColors() const;
};

}  // namespace smokebox

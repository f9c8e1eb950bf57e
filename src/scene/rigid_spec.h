// What a scene says of everything that moves by itself: bodies, particles, springs, joints, cloth, and the
// events that act on them. Part of the SceneSpec; SI units per metre of depth, angles in radians.
#pragma once
#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "base/color.h"
#include "geometry/shape.h"
#include "scene/expression.h"

namespace smokebox {

constexpr double kForever = std::numeric_limits<double>::infinity();

/// A free body, or a particle: a disk of a radius that has no spin and does not part the fluid.
struct BodySpec {
  std::string name;    // unique; copies of `repeat` are called name.0, name.1, ...
  std::string family;  // the name without the number, which stands for all copies
  bool particle = false;
  int item = -1;       // where it stands in `bodies` or `particles`; -1: an event adds it
  bool later = false;  // absent until an event adds it
  /// Copies share one shape; of a particle a circle.
  std::shared_ptr<const Shape> shape;
  Pose pose;  // of the shape's own (0, 0) at the start; the outline turns about its centre of mass
  Vec2 velocity;
  double spinRad = 0;          // rad/s
  std::optional<double> mass;  // kg; else density times area
  double density = 1;          // kg/m^2
  double bounce = 0, friction = 0.5, drag = 0;
  double linearDamping = 0, angularDamping = 0;  // 1/s
  double gravityScale = 1;
  std::vector<std::string> ignore;  // bodies that share a group pass through each other
  double heldUntil = 0;             // s; 0: never held, kForever: until an event releases it
  std::optional<Color> color;
};

/// What a spring, a joint or an event takes hold of, and where.
struct HoldSpec {
  enum class Of { world, solid, body, cloth };
  Of of = Of::world;
  int index = -1;  // in SceneSpec::solids, bodies or cloths
  int node = -1;   // of a cloth: column + row (columns + 1)
  /// In the coordinates of the outline as it is given (of the world: in its own); else the centre of mass.
  std::optional<Vec2> at;
  bool operator==(const HoldSpec&) const = default;
};

struct SpringSpec {
  std::string name;  // may be empty
  HoldSpec from, to;
  std::optional<double> length;  // at rest, m; else as long as it is at the start
  double stiffness = 0;          // N/m
  double damping = 0;            // N s/m
  std::optional<Color> color;
};

/// Places are in world coordinates at the start.
struct JointSpec {
  enum class Kind { pin, weld, slide, rope };
  Kind kind = Kind::pin;
  std::string name;              // may be empty
  HoldSpec a, b;                 // their `at` is not used
  std::optional<Vec2> at;        // pin, weld, slide; else b's centre of mass (a's if b is no body)
  Vec2 axis{1, 0};               // slide; of length 1
  std::optional<Vec2> from, to;  // rope; else the centres of mass
  std::optional<double> length;  // rope; else as long as it is at the start
  std::array<double, 2> limits{-kForever, kForever};  // pin: rad, slide: m, from the start
  double motorSpeed = 0, motorLimit = 0;              // rad/s and N m, or m/s and N
};

struct ClothSpec {
  std::string name;
  Vec2 corner, size;                             // lower left; m
  std::array<int, 2> cells{1, 1};                // along x and y; it has one particle more in each direction
  double mass = 1;                               // of the whole, kg
  double stiffness = 100, shear = 50, bend = 5;  // of each spring, N/m
  double damping = 0;                            // of each spring, N s/m
  double radius = 0;                             // of a particle, m
  double bounce = 0, friction = 0.5, linearDamping = 0, gravityScale = 1;
  std::vector<int> pinned;  // nodes, in order: column + row (cells[0] + 1)
  double tear = kForever;   // strain beyond which a spring breaks
  std::vector<std::string> ignore;
  std::optional<Color> color;

  int columns() const { return cells[0] + 1; }
  int rows() const { return cells[1] + 1; }
  Vec2 nodeAt(int node) const {
    return corner + Vec2{node % columns() * size.x / cells[0], node / columns() * size.y / cells[1]};
  }
};

/// Names that events use, and that nothing else has: bodies (all copies of a `repeat` too), particles, cloths
/// and their particles.
struct Movables {
  struct Node {
    int cloth, node;
    bool operator==(const Node&) const = default;
  };
  std::vector<int> bodies, cloths;
  std::vector<Node> nodes;
};

// --- events
struct ImpulseAction {
  Movables on;
  std::optional<Vec2> at;  // in the coordinates of the outline as it is given; else the centre of mass
  Vec2 value;              // N s, in the world's directions
};
/// A spring from a point of a body to a point that moves by a script.
struct PullAction {
  HoldSpec from;
  std::array<Expression, 2> to;  // of t
  double length = 0, stiffness = 0, damping = 0;
  double duration = kForever;
};
struct HoldAction {
  Movables what;
  bool held = true;  // false: released
};
struct RemoveAction {
  Movables what;
};
struct AddAction {
  int first = 0, count = 1;  // of SceneSpec::bodies
};
struct CutAction {
  std::vector<int> springs, joints;
};

}  // namespace smokebox

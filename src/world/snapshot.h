// What a picture needs to know of the world at one moment: a copy, so that the simulation can go on while it
// is drawn.
#pragma once
#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "base/color.h"
#include "base/field.h"
#include "geometry/grid.h"
#include "geometry/shape.h"
#include "scene/spec.h"

namespace smokebox {

struct SmokePicture {
  Color color;
  Field value;  // smoke value at cell centres
};

struct SolidPicture {
  std::string name;
  int index = 0;                  // in SceneSpec::solids: stable along the film
  std::vector<Outline> outlines;  // world coordinates now; holes clockwise
  Pose pose;
  std::optional<Color> color;
};

struct ProbePicture {
  std::string name;
  Vec2 at;                      // a point, or
  std::vector<Outline> region;  // the outline of the region now
};

/// A free body. What sticks out of a periodic side is there once more, shifted, with the same index.
struct BodyPicture {
  std::string name;
  int index = 0;                  // in SceneSpec::bodies: stable along the film
  std::vector<Outline> outlines;  // world coordinates now; holes clockwise
  Pose pose;                      // of the centre of mass: where it is, and how far it has turned
  std::optional<Color> color;
  double radius = 0;  // of a disk; 0: any other shape
};

struct ParticlePicture {
  Vec2 position;
  double radius = 0;
  int index = 0;  // in SceneSpec::bodies
  std::optional<Color> color;
};

/// A spring; also one by which an event pulls.
struct SpringPicture {
  Vec2 from, to;
  double tension = 0;  // N, positive where it pulls
  double length = 0;   // at rest, m; 0: it only pulls
  std::optional<Color> color;
  bool pull = false;  // an event's; `to` is the scripted end
};

struct JointPicture {
  JointSpec::Kind kind = JointSpec::Kind::pin;
  Vec2 a, b;                    // the points that it joins, world coordinates
  Vec2 axis;                    // of a slide, in the world now
  double length = 0;            // of a rope
  double lower = 0, upper = 0;  // of a slide: how far it may go along the axis, m; infinite without limits
  double motor = 0;             // speed that it is driven at, rad/s (pin) or m/s (slide); 0: no motor
};

struct ClothPicture {
  std::string name;
  int index = 0;                            // in SceneSpec::cloths
  int columns = 0, rows = 0;                // of particles
  std::vector<Vec2> positions;              // row by row from the lower left
  std::vector<char> whole;                  // of the (columns - 1) x (rows - 1) cells; a torn one is 0
  std::vector<std::array<int, 2>> threads;  // neighbours that still hold each other beside no whole cell
  double radius = 0;                        // of a particle
  std::optional<Color> color;
};

/// Two things that touch, or did a moment ago.
struct TouchPicture {
  Vec2 point, normal;
  double impulse = 0;   // N s
  double approach = 0;  // speed at which they met, m/s; 0 where they rest on each other
  double age = 0;       // s; those that rest are told of as long as they touch, with age 0
};

/// Where a body's centre of mass or a particle has been.
struct TrailPicture {
  int index = 0;             // in SceneSpec::bodies
  std::vector<Vec2> points;  // the oldest first, evenly spaced in time, up to now; NaN where it was wrapped
  double seconds = 0;        // from the first to the last
  std::optional<Color> color;
};

/// Fields that no layer asks for are empty.
struct Snapshot {
  double time = 0;
  long step = 0;
  Grid grid;
  bool periodicX = false, periodicY = false;
  std::vector<SmokePicture> smoke;
  Field open;         // open share of each cell, 0..1 (always set when there is a fluid)
  Field pressure;     // Pa, cell centres; extended into solids so that it can be interpolated up to edges
  Field vorticity;    // 1/s, at nodes (nx+1) x (ny+1), extended
  Field temperature;  // K, cell centres, extended
  Field velocityX, velocityY;        // m/s, cell centres, extended
  std::vector<SolidPicture> solids;  // only those shown
  std::vector<BodyPicture> bodies;   // only those shown, and there
  std::vector<ParticlePicture> particles;
  std::vector<SpringPicture> springs;
  std::vector<JointPicture> joints;
  std::vector<ClothPicture> cloths;
  std::vector<TouchPicture> touches;
  double usualImpulse = 1;  // N s: of a blow that is drawn at a middling size
  double usualTension = 1;  // N: of a spring that is drawn in a strong colour
  std::vector<TrailPicture> trails;
  std::optional<Vec2> followed;  // where the body is that the camera follows
  std::vector<ProbePicture> probes;
  std::vector<std::string> captions;  // all that are up now
  ViewSpec view;                      // as events have left it, without layers that are not shown
  /// The range of each field for the whole film: what the scene gives, or what was found beforehand.
  std::array<double, 2> pressureRange{-1, 1}, vorticityRange{-1, 1}, speedRange{0, 1}, temperatureRange{0, 1};

  bool shows(LayerKind kind) const {
    return std::any_of(view.layers.begin(), view.layers.end(),
                       [&](const LayerSpec& layer) { return layer.kind == kind; });
  }
};

}  // namespace smokebox

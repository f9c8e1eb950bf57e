// What a picture needs to know of the world at one moment: a copy, so that the simulation can go on while it
// is drawn.
#pragma once
#include <algorithm>
#include <array>
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

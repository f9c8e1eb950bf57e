// `smokebox plan`: what a scene will model, what it will not, and what that takes.
#pragma once
#include <string>
#include <vector>

#include "scene/spec.h"

namespace smokebox {

struct PlanLine {
  std::string stage;
  bool modelled = false;
  std::string why;  // what in the scene asks for it, or what is missing
};

struct Plan {
  std::vector<PlanLine> lines;
  int nx = 0, ny = 0;
  long cells = 0, steps = 0, frames = 0;
  int solids = 0, bodies = 0, smokeColors = 0;
  double memoryMb = 0;  // of the simulation's fields, about
};

Plan planOf(const SceneSpec& spec);

}  // namespace smokebox

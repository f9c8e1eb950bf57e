// The figures of a run: what `--stats` writes and what tests read. Names follow section 2 of the design.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "geometry/vec2.h"

namespace smokebox {

struct SmokeFigures {
  double mass = 0, emitted = 0, left = 0;  // m^2 of smoke
  double min = 0, max = 0;                 // smoke value
};

/// A solid with `report: true`, or a free body.
struct BodyFigures {
  std::string name;
  Vec2 position;  // of its centre of mass, m
  double angleDegrees = 0;
  Vec2 velocity;           // m/s, of the centre of mass
  double spinDegrees = 0;  // degrees/s
  Vec2 force;              // of the fluid on it, N per metre of depth
  double torque = 0;       // about the centre of mass, N m per metre of depth
};

struct ProbeFigures {
  std::string name;
  Vec2 velocity;
  double pressure = 0, smoke = 0, temperature = 0, mass = 0;
};

struct StepFigures {
  long step = 0;
  double time = 0;
  std::vector<std::pair<const char*, double>> stageMs;  // in the order of the step
  double totalMs = 0;
  int iterations = 0;
  double divergence = 0, compression = 0;
  SmokeFigures smoke;
  Vec2 momentum;               // of fluid, bodies, particles and cloth, N s per metre of depth
  double angularMomentum = 0;  // of bodies, particles and cloth about the origin, N m s per metre of depth
  double energyFluid = 0, energyBodies = 0;  // kinetic, J per metre of depth
  double energyPotential = 0;  // of bodies, particles and cloth in gravity (0 at height 0), and of springs
  int contacts = 0;            // points that touch
  double overlap = 0;          // the deepest, m
  std::vector<BodyFigures> bodies;
  std::vector<ProbeFigures> probes;
};

struct SummaryFigures {
  long steps = 0, cells = 0;
  int threads = 1;
  double stepMsMedian = 0;
  double divergenceMax = 0, smokeError = 0, overlapMax = 0;
  std::string stateHash;  // hexadecimal
};

}  // namespace smokebox

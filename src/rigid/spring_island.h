// Springs that hang together and are few, or in a chain: solved at once, with the stretch that they have at
// the sub-step's end. Each has two rows, along its line and across it. The row across stands for the force's
// turning with the line; it acts only where that is too stiff for the sub-step to follow (a long stretch of a
// strong spring), for it does not keep the angular momentum to the last bit.
#pragma once
#include <limits>

#include "rigid/block_factor.h"
#include "rigid/bodies.h"
#include "rigid/spring_row.h"

namespace smokebox {

struct Spring {
  SpringDef def;
  bool there = true;
  bool started = false;  // `between` is set
  bool fresh = true;     // has not pulled yet
  double impulse = 0;    // of the last sub-step along the line; negative: it pulls, N s
  Vec2 line{1, 0};       // from `from` to `to`
  Vec2 between;          // to - from, at the start of the last sub-step
  bool carried = false;  // its end in the world is on its way
  Vec2 carriedFrom, carriedTo;
  Vec2 shift;  // of its end in the world: periods that the other end had gone by when it was made, m
};

/// How far a step is, for ends that are carried.
struct StepClock {
  double dt = 0, elapsed = 0;  // s
};

/// Where an end is now; and its arm about the body's centre of mass.
struct SpringEnd {
  Vec2 at, arm;
};
SpringEnd springEnd(const Anchor& anchor, const Spring& spring, const Bodies& bodies, const StepClock& clock);
/// Of `to` less that of `from`, for ends in the world that are carried.
Vec2 carriedVelocity(const Spring& spring, const StepClock& clock);

class SpringIsland {
 public:
  /// False if it is too dense for a direct solve.
  bool layOut(const std::vector<int>& springs, const std::vector<Spring>& all, const Bodies& bodies);

  /// `hBefore`: the length of the last sub-step.
  void warmStart(std::vector<Spring>& springs, Bodies& bodies, const StepClock& clock, double h,
                 double hBefore);
  /// The largest change of a rate, m/s.
  double solve(std::vector<Spring>& springs, Bodies& bodies, double h);

  std::size_t bytes() const;

 private:
  struct Link {
    int spring = 0;
    int a = -1, b = -1;
    Vec2 armA, armB, direction[2], carried, between;
    double distance = 0;
    SoftRow row[2];
    double inertia[2] = {0, 0};
    double across = 0;  // impulse of the second row
  };
  struct Coupling {
    int slot = 0, row = 0, column = 0, body = 0;
  };

  void factor(const Bodies& bodies);
  static std::array<double, 2> ratesOf(const Link& link, const Bodies& bodies, double h);

  std::vector<Link> links_;
  std::vector<Coupling> couplings_;
  BlockFactor<2> matrix_;
  std::vector<std::array<double, 2>> unknowns_;
};

}  // namespace smokebox

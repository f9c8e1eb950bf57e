// Nothing passes through anything within a sub-step: the ways of pairs that move far against each other are
// swept (conservative advancement, Mirtich 1996), and both bodies wait where they meet; velocities stay.
//
// Who waits for a solid that a script moves is carried by it, and so is who waits for that one. What has
// waited may be met by others, which is looked for again up to a number of rounds.
#pragma once
#include <vector>

#include "rigid/bodies.h"
#include "rigid/broad_phase.h"
#include "rigid/collide_bodies.h"

namespace smokebox {

/// Beyond this share of the thinner one's width in a sub-step, a pair is swept.
constexpr double kSwept = 0.25;
/// Swept pairs meet at this share of the thinner one's width from each other.
constexpr double kSweptTarget = 1e-3;

class Passing {
 public:
  /// `since`: by body, the moment within the sub-step from which its way is straight (null: its start). Cuts
  /// and bends `way`.
  void stop(const Bodies& bodies, const BroadPhase& broad, const std::vector<PairKey>& pairs, double h,
            const std::vector<double>* since, std::vector<Motion>& way);

 private:
  /// From `share` of its way on a body waits, or moves with the carrier, whose image at `shift` is meant.
  struct Stop {
    double share = 1;
    int carrier = -1;
    Vec2 shift;
  };
  Motion displaced(const Bodies& bodies, const std::vector<Motion>& way, int body, double share) const;
  bool stopPair(const Bodies& bodies, const std::vector<Motion>& way, const PairKey& key, Vec2 shift,
                double past);
  bool waits(const Bodies& bodies, const std::vector<Motion>& way, int body, int other, double share,
             Vec2 shift);

  std::vector<Stop> stops_;
  std::vector<PiecePair> pieces_;
};

}  // namespace smokebox

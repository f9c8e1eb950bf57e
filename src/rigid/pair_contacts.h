// The contacts of one pair of bodies: found at its places now, or where a swept test says that they will
// meet; carried along with bodies that move a little; and bounds, cheap, on how near the two can be.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "rigid/broad_phase.h"
#include "rigid/collide_bodies.h"
#include "rigid/contact.h"

namespace smokebox {

/// A point that has moved by less than this share of the thinner one's width goes on where another one was.
constexpr double kSamePlace = 0.1;
/// Cosine between the normals of two contacts of which one goes on where the other was.
constexpr double kSameWay = 0.7;

/// The smaller of two bodies' smallest widths, m.
inline double thinner(const Bodies& bodies, int a, int b) {
  return std::min(bodies.extent[a].thinnest, bodies.extent[b].thinnest);
}
/// Largest speed of any point of one against any of the other, m/s.
inline double relativeSpeed(const Bodies& bodies, int a, int b) {
  const Motion &va = bodies.velocity[a], &vb = bodies.velocity[b];
  return length(va.linear() - vb.linear()) + std::abs(va.turn) * bodies.extent[a].turningReach() +
         std::abs(vb.turn) * bodies.extent[b].turningReach();
}
/// A bound from below on how far two bodies are apart, m: by the circles around them, then by the box of one
/// and the circle of the other. `enough`: what needs no better one.
double clearance(const Bodies& bodies, const PairKey& key, Vec2 shift, double enough);
/// Friction and bounce of a contact, from its bodies'.
void setSurfaces(const Bodies& bodies, Contact& contact);
/// Moves a contact along with its bodies, which have moved a little since it was found: the normal turns with
/// the one whose edge it stands on, the points go with the other one's corners. `turned`: by body, by how
/// much since.
void bringUpToDate(const Bodies& bodies, const std::vector<Turn>& turned, Contact& contact);

/// Gives a contact the impulses of the one of `old` that is between the same pieces: point by point where the
/// same edge and corner meet, else to a point no farther than `near` metres from where it was. What lies on a
/// corner changes edges, and must not lose its hold on what it bears.
template <class Old>
void inheritImpulses(const Old* old, int count, double near, Contact& contact) {
  auto pass = [](const ContactPoint& from, ContactPoint& to) {
    to.impulseN = from.impulseN;
    to.impulseT = from.impulseT;
  };
  for (int o = 0; o < count; ++o) {
    const Contact& before = old[o];
    if (before.pieceA != contact.pieceA || before.pieceB != contact.pieceB) continue;
    contact.approach = std::max(contact.approach, before.approach);
    bool given[2] = {false, false}, taken[2] = {false, false};
    for (int k = 0; k < contact.count; ++k)
      for (int l = 0; l < before.count; ++l)
        if (before.feature[l] == contact.feature[k]) {
          pass(before.points[l], contact.points[k]);
          given[l] = taken[k] = true;
        }
    if (dot(before.normal, contact.normal) < kSameWay) continue;
    for (int k = 0; k < contact.count; ++k)
      for (int l = 0; l < before.count && !taken[k]; ++l) {
        const Vec2 apart = contact.points[k].armA - before.points[l].armA;
        if (given[l] || dot(apart, apart) > near * near) continue;
        pass(before.points[l], contact.points[k]);
        given[l] = taken[k] = true;
      }
  }
}

class PairContacts {
 public:
  /// The moment within the sub-step from which contacts are looked for, and what impacts before it have
  /// changed of the two bodies' ways.
  struct Later {
    double time = 0;
    Motion struckA, struckB;
  };
  /// Adds the contacts of a pair whose gap is below `margin`; `swept`: of pieces that meet within `h`
  /// seconds. Gives how far the two are surely apart: 0 where there are any. They are without impulses.
  double find(const Bodies& bodies, const PairKey& key, Vec2 shift, double margin, double h, bool swept,
              std::vector<Contact>& found, const Later& later);

  /// Asks the memory for what find() will read of the next ones of `count` pairs; keyOf(k) is the k-th's.
  template <class KeyOf>
  static void askAhead(const Bodies& bodies, std::size_t at, std::size_t count, KeyOf&& keyOf) {
    constexpr std::size_t kLong = 8, kSoon = 4;
    for (const std::size_t ahead : {kLong, kSoon}) {
      if (at + ahead >= count) continue;
      const PairKey key = keyOf(at + ahead);
      prefetch(bodies, key.a, ahead == kSoon);
      prefetch(bodies, key.b, ahead == kSoon);
    }
  }

 private:
  /// Of a body of one piece: long before, and soon before.
  static void prefetch(const Bodies& bodies, int body, bool soon);

  std::vector<PiecePair> pieces_;
};

}  // namespace smokebox

// Where two pieces of two bodies touch or are about to: one normal and up to two points.
#pragma once
#include <cstdint>

#include "geometry/vec2.h"

namespace smokebox {

struct ContactPoint {
  Vec2 armA, armB;  // from each body's centre of mass
  double gap = 0;   // m, below 0: overlap; for the bodies' places when the contact was found
  double impulseN = 0, impulseT = 0;  // N s of a sub-step
};

/// Three lines of the cache, of which each step of many bodies reads and writes all there are.
struct alignas(64) Contact {
  int a = 0, b = 0;
  int pieceA = 0, pieceB = 0;
  std::int8_t count = 0;              // of points
  std::int8_t face = 0;               // whose edge gives the normal and meets corners: 1 a, 2 b; 0: none
  std::int8_t sx = 0, sy = 0;         // the image of b that is meant, as PairKey has it
  bool struck = false;                // had an impact in this sub-step
  bool met = false;                   // an impact has placed its points anew
  std::uint32_t feature[2] = {0, 0};  // by point: the edge and the corner that meet
  Vec2 normal;                        // from a to b
  double friction = 0, bounce = 0;
  double approach = 0;  // fastest at which its points met in this step, m/s
  double total = 0;     // N s along the normal in this step, impacts too
  ContactPoint points[2];
};
static_assert(sizeof(Contact) == 192);

/// One that is solved by itself, with what that takes.
struct SolvedContact : Contact {
  SolvedContact() = default;
  explicit SolvedContact(const Contact& contact) : Contact(contact) {}
  double spare = 0;   // parted faster than it needs by so much in the last sweep, m/s; 0: bears
  double change = 0;  // of a relative velocity in the last sweep, m/s
  /// Of the points' parting speeds to impulses: 0 to 0, each to the other, 1 to 1, and one over the
  /// determinant; that is 0 where two points are hardly two.
  double response[4] = {0, 0, 0, 0};
  double massN[2] = {0, 0}, massT[2] = {0, 0};  // effective masses along the normal and the tangent, kg
  double allowed[2] = {0, 0};                   // speed at which the gap may close in a sub-step, m/s
};

}  // namespace smokebox

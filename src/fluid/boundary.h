// All that the fluid knows of the domain's walls and of the solids in it. The coupling fills it; the stages
// read it.
//
// What closes a face (a solid, a closed wall, an inflow) drives fluid through it at its own speed: an inflow
// is a closed face whose wall moves inwards. The volume flux through x-face (i, j) is therefore, per unit of
// length,
//   openX u + (1 - openX) wallU.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "base/field.h"
#include "geometry/grid.h"
#include "geometry/region_map.h"
#include "geometry/walls.h"

namespace smokebox {

/// One side of the domain, face by face (ny faces on the left and right, nx at the bottom and top).
struct SideFlow {
  WallKind kind = WallKind::slip;
  std::vector<float> u, v;  // velocity of wall or inflow at the middle of each face, m/s; empty means 0
};

/// A link of the viscous stencil that ends on a surface before it reaches the next velocity (Gibou 2002).
struct CutLink {
  int i = 0, j = 0;    // the x-face (links of u) or y-face (links of v) that it starts from
  int di = 0, dj = 0;  // one of (1,0) (-1,0) (0,1) (0,-1)
  float theta = 1;     // length of the link in cells, [1e-3, 1]
  float drag =
      1;  // share of the tangential velocity in common: 0 slip .. 1 no-slip; scales the link's weight
  float velocity = 0;  // the surface's velocity there: its x component for u, its y component for v
  int solid = -1;      // index of the solid, -1 for a wall of the domain
};

struct Boundary {
  Grid grid;
  std::array<SideFlow, 4> sides;  // indexed by Side; opposite sides are periodic together

  Field openX, openY;  // open share of each face, 0..1; exactly 0 or at least kSmallestOpening
  Field volume;        // open share of each cell's area, 0..1
  Field wallU, wallV;  // velocity of what closes the face, along its normal; 0 where a face is fully open
  std::vector<CutLink> linksU, linksV;  // sorted by j, then i; the walls' too
  RegionMap regions;                    // of the open cells; empty: not told apart
  std::uint64_t version = 0;            // grows whenever a fraction changes (velocities may change without)

  static constexpr float kSmallestOpening = 1e-3f;

  const SideFlow& side(Side s) const { return sides[static_cast<int>(s)]; }
  bool periodicX() const { return side(Side::left).kind == WallKind::periodic; }
  bool periodicY() const { return side(Side::bottom).kind == WallKind::periodic; }
  bool open(Side s) const { return side(s).kind == WallKind::open; }
};

/// Fills the layer of cells around the domain of a field at cell centres: from the other side where it is
/// periodic, else with the nearest cell, so that the mean of two cells is right on the faces of the rim too.
void fillRim(const Boundary& boundary, Field& cells);

}  // namespace smokebox

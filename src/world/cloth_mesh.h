// A cloth as the system of bodies knows it: particles at the corners of its cells, joined by springs between
// neighbours (structural), across each cell (shear) and over two cells (bend). Its particles pass through
// each other.
//
// A cloth that may tear loses a spring whose strain goes too far, and with a structural spring those that
// bend over it; a cell is whole as long as both its diagonals are, and not two edges that face each other
// are gone.
//
// A cell that is turned over (seen from behind: a fold) would be at rest like that, for its springs only know
// lengths, and to turn back it would have to be crushed first. So the springs of such a cell and at it do not
// push: what is folded hangs like a net, and what pulls turns it back. Then they get their length back little
// by little.
#pragma once
#include <memory>
#include <vector>

#include "rigid/system.h"
#include "scene/spec.h"
#include "world/snapshot.h"

namespace smokebox {

class ClothMesh {
 public:
  /// `ignore`: the bits of its groups, and one of its own.
  ClothMesh(const ClothSpec& spec, std::shared_ptr<const BodyShape> particle, std::uint64_t ignore,
            RigidSystem& system);

  const ClothSpec& spec() const { return spec_; }
  void setColor(std::optional<Color> color) { spec_.color = color; }
  /// Number in the system; a particle may have been removed.
  int body(int node) const { return bodies_[node]; }
  const std::vector<int>& bodies() const { return bodies_; }
  bool shown = true;

  void remove(RigidSystem& system) const;
  bool isThere(const RigidSystem& system) const;
  /// After a step: what has torn, and what is turned over.
  void update(RigidSystem& system, double dt);
  void capture(const RigidSystem& system, int index, ClothPicture& picture) const;

 private:
  struct Link {
    int spring = -1;
    bool there = false;
    double length = 0;
    float slack = 0;  // share of the length
  };
  int node(int i, int j) const { return i + j * spec_.columns(); }
  Link join(int a, int b, double stiffness, double tear, RigidSystem& system) const;
  void dropTorn(RigidSystem& system);
  bool lostCorner(int i, int j, const RigidSystem& system) const;
  bool cellIsWhole(int i, int j) const;
  void loosen(RigidSystem& system, double dt);
  float slackAt(int i, int j) const;

  ClothSpec spec_;
  std::vector<int> bodies_;
  // By the node that they start from: to the right and upwards, one and two cells far; and by the cell.
  std::vector<Link> right_, up_, farRight_, farUp_, rising_, falling_;
  std::vector<char> whole_, lost_;  // by cell; lost: a corner of it has been removed
  std::vector<float> slack_;        // by cell: 1 while it is turned over, then less and less
  bool slackened_ = false;          // one is over 0
  long removed_ = 0;                // springs of the system that were gone at the last look
};

}  // namespace smokebox

// Contacts that stay as they are for a whole step, solved eight at a time: warm-started projected
// Gauss-Seidel on impulses with Coulomb's friction (Catto 2005, Iterative Dynamics with Temporal Coherence),
// in colours: no moving body is met twice within a block, so the order of the lanes does not matter.
//
// A contact that is not closed yet may close within the sub-step but not go beyond (Mirtich's and Catto's
// speculative contact): v_n >= -gap / h. What overlaps is moved apart on places alone, as the
// first sweep of the next sub-step comes by.
#pragma once
#include <vector>

#include "rigid/bodies.h"
#include "rigid/contact.h"

namespace smokebox {

class ContactBlocks {
 public:
  static constexpr int kLanes = 8;
  static constexpr int kNumbers = 4;  // in a Motion
  typedef double Lanes __attribute__((vector_size(64)));
  typedef float ShortLanes __attribute__((vector_size(32)));
  struct Motions {
    Lanes x, y, turn;
  };

  /// Colours the contacts, which need no effective masses, and lays them out; `down`: along gravity, of
  /// length 1, or (0, 0). Those that find no colour are listed in `rest`.
  void build(const Bodies& bodies, const std::vector<Contact>& contacts, std::vector<int>& rest, Vec2 down);
  bool empty() const { return blocks_.empty(); }
  /// Points that a sweep solves, empty lanes too.
  long points() const { return points_; }

  /// So many that one sweep in a sub-step has to do.
  bool areMany() const;

  /// Adds the impulses to the velocities.
  void warmStart(Bodies& bodies) const;
  /// Who overlaps by more than `slop` metres is moved apart by a share of that, at most `most` metres.
  struct Apart {
    double slop, share, most;
  };
  /// One sweep: the first of a sub-step, which moves bodies apart too, or a further one (null). Gives the
  /// largest change of a relative velocity, m/s.
  double solve(Bodies& bodies, double h, const Apart* first);
  /// From here on solveRough() goes over the blocks that the last sweep changed by `above` or more, and
  /// leaves out those that it changes by less.
  void beginRough(double above);
  double solveRough(Bodies& bodies, double h, double above);
  /// Takes contact `index` out for the rest of the step; `contact` gets its impulses.
  void drop(int index, Contact& contact);
  /// Copies the impulses of contact `index` back, the last ones and their total; one that was dropped keeps
  /// its own.
  void readBack(int index, Contact& contact) const;
  /// visit(impulses, effective masses, kLanes) for the points' normals and tangents, in a fixed order; who
  /// changes them brings the velocities along.
  template <class Visit>
  void eachImpulse(Visit&& visit) {
    for (Block& block : blocks_) {
      block.spare = 0;
      for (int k = 0; k < block.count; ++k) {
        Point& p = block.points[k];
        visit(reinterpret_cast<double*>(&p.impulseN), reinterpret_cast<const float*>(&p.massN), kLanes);
        visit(reinterpret_cast<double*>(&p.impulseT), reinterpret_cast<const float*>(&p.massT), kLanes);
      }
    }
  }
  /// visit(body) for the bodies of all contacts, some more than once.
  template <class Visit>
  void eachBody(Visit&& visit) const {
    for (const Block& block : blocks_)
      for (int l = 0; l < kLanes; ++l) {
        if (block.contact[l] < 0) continue;
        visit(block.a[l] / kNumbers);
        visit(block.b[l] / kNumbers);
      }
  }
  std::size_t bytes() const { return blocks_.capacity() * sizeof(Block); }

 private:
  struct Block;
  template <int kPoints>
  static double solvePoints(Block& block, Bodies& bodies, double perSecond, const Apart* first);
  static double solveBlock(Block& block, Bodies& bodies, double perSecond, const Apart* first);
  static void separate(const Block& block, const Apart& apart, Motion* moved, Motions& da, Motions& db);
  static void fill(Block& block, const Bodies& bodies, const std::vector<Contact>& contacts,
                   const int* which);
  static void readLane(const Block& block, int lane, Contact& contact);
  // What does not change is kept short: a sweep over many contacts waits for the memory. Both bodies get the
  // same impulse, so momentum is kept to rounding whatever the normal's.
  struct Point {
    ShortLanes armAN, armBN, armAT, armBT;  // arm x normal, arm x tangent
    ShortLanes massN, massT;                // over-relaxed where there are many
    Lanes gap, impulseN, impulseT;
  };
  struct alignas(64) Block {
    int a[kLanes], b[kLanes];  // where the bodies' motions begin, in numbers
    int contact[kLanes];       // -1: empty lane
    int count;                 // points of its contacts: 1 or 2
    double change;             // of a relative velocity in the last sweep, m/s
    double spare;              // all parted faster than they need by so much in the last sweep, m/s; 0: none
    ShortLanes nx, ny, friction;
    ShortLanes inverseA, inertiaA, inverseB, inertiaB;
    Lanes total;  // N s along the normal so far in this step, but for the last sub-step
    Point points[2];
  };
  std::vector<Block> blocks_;
  std::vector<int> rough_;  // blocks
  long points_ = 0;
  double change_ = 0;                       // of the last sweep
  std::vector<std::uint64_t> used_;         // colours at each body
  std::vector<int> colour_, kind_, place_;  // by contact: colour; block * kLanes + lane, or -1
  std::vector<int> start_, inLane_;
  struct Brief {
    int a, b, rank, count;
  };
  std::vector<Brief> brief_;  // of the contacts, for colouring
};

}  // namespace smokebox

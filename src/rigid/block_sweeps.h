// Sweeps over contacts, several at a time: warm-started projected Gauss-Seidel on impulses with Coulomb's
// friction (Catto 2005, Iterative Dynamics with Temporal Coherence).
//
// A contact that is not closed yet may close within the sub-step but not go beyond (Mirtich's and Catto's
// speculative contact): v_n >= -gap / h. What overlaps is moved apart on places alone, as the first sweep of
// the next sub-step comes by.
//
// The second sweep of a sub-step is the first one's mirror image, in the order of the colours and within a
// contact, and so is the first one of the next sub-step: errors that one order leaves on one side, which make
// walls lean, do not add up (symmetric successive over-relaxation; Young 1971, ch. 15).
//
// The blocks of a colour meet no body twice that moves: several threads work on them, and the result is the
// same for any number of those.
//
// Number: what a block is worked in. The bodies' velocities and places are in float64 whatever it is, and
// blocks work on differences of those.
#pragma once
#include <utility>
#include <vector>

#include "base/threads.h"
#include "rigid/bodies.h"
#include "rigid/contact.h"
#include "rigid/contact_layout.h"
#include "rigid/motion_lanes.h"

namespace smokebox {

/// Who overlaps by more than `slop` metres is moved apart by a share of that, at most `most` metres; several
/// times in a sub-step where it is more than `deep`.
struct MoveApart {
  double slop, share, most, deep;
};

template <class Number>
class BlockSweeps {
 public:
  static constexpr int kLanes = WideOf<Number>::kCount;

  explicit BlockSweeps(ThreadPool& pool) : pool_(pool) {}
  /// The contacts, which need no effective masses, as they are laid out. `relaxation`: each gives so many
  /// times what it is asked for (successive over-relaxation).
  void fill(const Bodies& bodies, const std::vector<Contact>& contacts, const ContactLayout& layout,
            Number relaxation);
  void clear();
  /// Adds the impulses to the velocities.
  void warmStart(Bodies& bodies) const;
  /// The first sweep of a sub-step, which sees how near all are, and moves bodies apart. Gives the largest
  /// change of a relative velocity, m/s.
  double sweepFirst(Bodies& bodies, double h, const MoveApart& apart);
  /// A further one.
  double sweep(Bodies& bodies);
  /// From here on sweepRough() goes over the blocks that the last sweep changed by `above` or more, and
  /// leaves out those that it changes by less.
  void beginRough(double above);
  double sweepRough(Bodies& bodies, double above);
  /// Contacts that the next one goes over, at most.
  long roughSize() const { return kLanes * static_cast<long>(rough_.size()); }
  /// Once more over those that overlapped by more than `apart.deep` as the first sweep of this sub-step came
  /// by, on places alone. False if there is none.
  bool separateDeep(Bodies& bodies, const MoveApart& apart);
  /// The impulses at a place: the last ones, and their total.
  void read(int place, Contact& contact) const;
  /// Takes out what is at a place.
  void drop(int place);
  /// visit(impulses, effective masses, kLanes) for the points' normals and tangents, in a fixed order; who
  /// changes them brings the velocities along.
  template <class Visit>
  void eachImpulse(Visit&& visit) {
    for (Block& block : blocks_) {
      block.spare = 0;
      for (int k = 0; k < block.count; ++k) {
        Point& p = block.points[k];
        visit(numbers(p.impulseN), numbers(std::as_const(p.massN)), kLanes);
        visit(numbers(p.impulseT), numbers(std::as_const(p.massT)), kLanes);
      }
    }
  }
  /// visit(body) for the bodies of all contacts, some more than once.
  template <class Visit>
  void eachBody(Visit&& visit) const {
    for (const Block& block : blocks_)
      for (int l = 0; l < kLanes; ++l) {
        if (block.a[l] == block.b[l]) continue;
        visit(block.a[l] / motion_lanes::kNumbers);
        visit(block.b[l] / motion_lanes::kNumbers);
      }
  }
  std::size_t bytes() const { return blocks_.capacity() * sizeof(Block); }

 private:
  using Vector = typename WideOf<Number>::Type;
  using Pushes = Relative<Vector>;  // along x and y on b (a gets the opposite), and what each gains in spin
  struct Point {
    Vector armAN, armBN, armAT, armBT;  // arm x normal, arm x tangent
    Vector massN, massT;                // effective masses, times the relaxation
    Vector impulseN, impulseT;
    Vector allowed;  // speed at which the gap may close in this sub-step, m/s
    Vector gap;
  };
  static Number* numbers(Vector& of) { return reinterpret_cast<Number*>(&of); }
  static const Number* numbers(const Vector& of) { return reinterpret_cast<const Number*>(&of); }
  struct alignas(64) Block {
    int a[kLanes], b[kLanes];  // where the bodies' motions begin, in numbers; the same: empty
    int count;                 // points of its contacts: 1 or 2
    Number change;             // of a relative velocity in the last sweep, m/s
    Number spare;              // all parted faster than they need by so much in the last sweep, m/s; 0: none
    Vector nx, ny, friction;
    Vector inverseA, inertiaA, inverseB, inertiaB;
    /// How much an impulse at one point gives the other one in its place, first to second and back; and one
    /// over 1 less their product.
    Vector secondByFirst, firstBySecond, both;
    Vector total;  // N s along the normal so far in this step, but for the last sub-step
    Point points[2];
  };

  static void fillBlock(Block& block, const Bodies& bodies, const std::vector<Contact>& contacts,
                        const int* which, Number relaxation);
  /// Gives the deepest overlap; 0: none.
  static Number begin(Block& block, Motion* moved, Number perSecond, const MoveApart& apart);
  enum class Order { normalsFirst, frictionFirst };
  static void separate(const Block& block, const MoveApart& apart, Motion* moved, Relative<Vector>& d);
  template <int kPoints>
  static void changeNormals(Block& block, const Relative<Vector>& v, Vector parts[kPoints],
                            Vector change[kPoints]);
  template <int kPoints>
  static Pushes solve(Block& block, Relative<Vector> v, Order order);
  static Number solveSome(Block* const* some, int count, Order order, Motion* velocity);
  /// With a share for effective masses that hold the relaxation.
  MoveApart unrelaxed(const MoveApart& apart) const {
    return {apart.slop, apart.share / static_cast<double>(relaxation_), apart.most, apart.deep};
  }
  /// The largest of todo(begin, end) over the blocks of each colour, from the first to the last one or back.
  template <class Todo>
  Number eachColour(bool back, Todo&& todo);
  /// The same over a part of what todo() counts, which may be cut.
  template <class Todo>
  Number shared(int begin, int end, Todo&& todo);

  ThreadPool& pool_;
  std::vector<Block> blocks_;
  std::vector<int> colourEnds_;  // in blocks_
  std::vector<int> rough_;       // blocks
  std::vector<int> deep_;        // blocks
  std::vector<Number> overlap_;  // by block: the deepest, as this sub-step's first sweep came by
  Number change_ = 0;            // of the last sweep
  bool back_ = false;            // the first sweep of this sub-step went from the last colour to the first
  Number relaxation_ = 1;
};

}  // namespace smokebox

// Contacts that stay as they are for a whole step, solved several at a time (block_sweeps.h): few in float64,
// so that what stands stands; many, which are not settled to the last anyhow, in float32, twice as many at a
// time.
#pragma once
#include <vector>

#include "rigid/block_sweeps.h"
#include "rigid/contact_layout.h"

namespace smokebox {

class ContactBlocks {
 public:
  explicit ContactBlocks(ThreadPool& pool) : exact_(pool), brief_(pool) {}
  /// Lays the contacts out, which need no effective masses; `down`: along gravity, of length 1, or (0, 0).
  /// Those that find no place are listed in `rest`. `areRough`: the sweeps of the last step did not settle
  /// them.
  void build(const Bodies& bodies, const std::vector<Contact>& contacts, std::vector<int>& rest, Vec2 down,
             bool areRough);
  bool empty() const { return layout_.blocks() == 0; }
  /// Points of all contacts.
  long points() const { return points_; }

  /// So many that one sweep in a sub-step has to do.
  bool areMany() const;

  /// Adds the impulses to the velocities.
  void warmStart(Bodies& bodies) const;
  /// A sweep, as in block_sweeps.h: the first of a sub-step, a further one, or over what is rough.
  double sweepFirst(Bodies& bodies, double h, const MoveApart& apart);
  double sweep(Bodies& bodies);
  bool separateDeep(Bodies& bodies, const MoveApart& apart);
  void beginRough(double above);
  double sweepRough(Bodies& bodies, double above);
  long roughSize() const { return isBrief_ ? brief_.roughSize() : exact_.roughSize(); }
  /// Takes contact `index` out for the rest of the step; `contact` gets its impulses.
  void drop(int index, Contact& contact);
  /// Copies the impulses of contact `index` back, the last ones and their total; one that was dropped keeps
  /// its own.
  void readBack(int index, Contact& contact) const;
  template <class Visit>
  void eachImpulse(Visit&& visit) {
    inUse(*this, [&](auto& blocks) { blocks.eachImpulse(visit); });
  }
  template <class Visit>
  void eachBody(Visit&& visit) const {
    inUse(*this, [&](auto& blocks) { blocks.eachBody(visit); });
  }
  std::size_t bytes() const { return exact_.bytes() + brief_.bytes(); }

 private:
  template <class Self, class Todo>
  static auto inUse(Self& self, Todo&& todo) {
    return self.isBrief_ ? todo(self.brief_) : todo(self.exact_);
  }

  ContactLayout layout_;
  BlockSweeps<double> exact_;
  BlockSweeps<float> brief_;
  bool isBrief_ = false;
  long points_ = 0;
};

}  // namespace smokebox

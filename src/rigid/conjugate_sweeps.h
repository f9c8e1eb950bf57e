// Makes sweeps over contacts converge in far fewer rounds where many hang on one another (stacks, piles):
// nonsmooth nonlinear conjugate gradients (Silcowitz, Niebe and Erleben 2010). What a sweep changes of the
// impulses counts as the gradient; a share of the last direction is added after it (Fletcher and Reeves), and
// the next sweep brings back into their bounds what has left them.
#pragma once
#include <vector>

#include "rigid/bodies.h"
#include "rigid/contact.h"
#include "rigid/contact_blocks.h"

namespace smokebox {

class ConjugateSweeps {
 public:
  /// Forgets the direction: other contacts come.
  void restart() {
    known_ = false;
    bodies_.clear();
  }
  /// Before a sweep.
  void remember(const Bodies& bodies, ContactBlocks& blocks, std::vector<SolvedContact>& spare,
                std::vector<SolvedContact>& lively);
  /// After it, if another one follows: moves impulses and velocities on.
  void extrapolate(Bodies& bodies, ContactBlocks& blocks, std::vector<SolvedContact>& spare,
                   std::vector<SolvedContact>& lively);

 private:
  void list(const Bodies& bodies, const ContactBlocks& blocks, const std::vector<SolvedContact>& spare,
            const std::vector<SolvedContact>& lively);

  bool known_ = false;  // there is a direction
  double size_ = 0;     // of the last gradient, J
  std::vector<double> impulses_, direction_;
  std::vector<int> bodies_;  // that have contacts
  std::vector<char> isListed_;
  std::vector<Motion> velocities_, turnedTo_;  // of those; turnedTo_: the direction's velocities
};

}  // namespace smokebox

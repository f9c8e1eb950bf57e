// What solids that are moved by a script press between them, or against other solids, and cannot make room:
// no impulse is large enough, and the largest that the contact solver comes to would shoot something out of
// the column. It leaves gently: bodies of an island of contacts that touches two solids of which one moves
// get no faster than some times the solid, or somewhat more than the fastest of them was. What only free
// bodies do to one another has no limit.
#pragma once
#include <vector>

#include "rigid/bodies.h"
#include "rigid/contact.h"

namespace smokebox {

class Press {
 public:
  /// A step is over; false: no solid has moved in it, and there are no contacts to be told of.
  bool begin(const Bodies& bodies);
  /// A contact of that step.
  void add(const Bodies& bodies, const Contact& contact);
  void end(const Bodies& bodies);
  /// Did solids press something in the last step?
  bool isOn() const { return !most_.empty(); }
  /// Slows down what has become too fast.
  void yield(Bodies& bodies) const;

 private:
  struct Rest {
    int body = 0, solid = 0;
    double speed = 0;  // of the solid where they touch, m/s
  };
  int rootOf(int body);

  std::vector<int> parent_, solid_;  // by body; by root: a solid that it touches, -1 none, -2 several
  std::vector<Rest> rests_;
  std::vector<double> driven_, fastest_;  // by root, m/s
  std::vector<double> most_;              // by body, m/s; empty: no press
};

}  // namespace smokebox

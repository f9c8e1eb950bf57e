// What solids that are moved by a script press between them, or against other solids, and cannot make room:
// no impulse is large enough, and the largest that the contact solver comes to would shoot something out of
// the column. It leaves gently: bodies of an island of contacts that touches two solids of which one moves
// get no faster than some times the solid, or somewhat more than the fastest of them was. What only free
// bodies do to one another has no limit.
//
// What a press has driven deep into each other is sunk, until it has come out again: there is no exact answer
// to look for, so that such bodies are worth no more work than others.
#pragma once
#include <vector>

#include "rigid/bodies.h"
#include "rigid/contact.h"

namespace smokebox {

class Press {
 public:
  /// A step is over; false: no solid has moved in it, nothing was sunk, and there are no contacts to be told
  /// of.
  bool begin(const Bodies& bodies);
  /// A contact of that step; `overlap`: at its end, m.
  void add(const Bodies& bodies, const Contact& contact, double overlap);
  void end(const Bodies& bodies);
  /// Was there such an island in the last step, or something sunk?
  bool isOn() const { return isOn_; }
  /// Is all that is pressed where it may be, but for a few bodies?
  bool hasRoom() const { return hasRoom_; }
  /// How deep a sunk body lay in others at the end of the last step, m, its smallest width at most; else 0.
  double sunk(int body) const { return body < static_cast<int>(sunk_.size()) ? sunk_[body] : 0; }
  /// Is one of them sunk? It does not bounce.
  bool sinks(int a, int b) const { return sunk(a) > 0 || sunk(b) > 0; }
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
  std::vector<double> most_;              // by body, m/s; empty: no solid moves
  std::vector<double> sunk_, deep_;       // by body, m; sunk_ is empty: none; deep_: of all
  bool isOn_ = false, hasRoom_ = true;
};

}  // namespace smokebox

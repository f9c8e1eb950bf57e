// Impacts within a sub-step, one after the other at their own moments: Newton's restitution on the true speed
// of approach, then Coulomb's friction.
//
// With a leapfrog velocity v (of the middle of the sub-step) and the bodies' relative acceleration a of
// gravity along the normal, the gap is g + (v - a h/2) t + a t^2/2 and the speed of approach at its root t is
// w = v + a (t - h/2). The impulse changes v by -(1 + e) w, and the body's way by -t times the change of its
// velocity: so flight, bounce and flight again are exact, whenever within the sub-step the bounce falls.
// Impulses go on (body to body to body: a cradle) until nothing approaches, up to a number for each body;
// each one takes energy or keeps it, so that however many there are, none is added. A step has a bound, too.
#pragma once
#include <array>
#include <vector>

#include "rigid/bodies.h"
#include "rigid/contact.h"
#include "rigid/joint_set.h"

namespace smokebox {

class Impacts {
 public:
  explicit Impacts(JointSet& joints) : joints_(joints) {}

  void beginStep() { inStep_ = 0; }
  /// Before the first run of a sub-step. `flying`, by body: nothing pressed on it in the last one.
  void begin(const std::vector<char>& flying);
  /// `contacts`: those that may bounce. Slower approaches than `least` (m/s) are left to the contact solver.
  /// Adds what the impacts change of the bodies' ways to `way`. In a further run of a sub-step only what has
  /// been struck can have come upon something new.
  void run(Bodies& bodies, const std::vector<Contact*>& contacts, double h, Vec2 gravity, double least,
           std::vector<Motion>& way, bool again);
  /// By body: moment of its last impact within the sub-step.
  const std::vector<double>& moments() const { return struckAt_; }
  bool wasStruck(int body) const { return times_[body] > 0; }
  long count() const { return count_; }  // of the last run

 private:
  struct Event {
    double time;
    int contact, stamp;
    bool operator<(const Event& o) const {  // of a heap: the earliest on top
      return time > o.time || (time == o.time && contact > o.contact);
    }
  };
  struct Approach {
    double time = 0,
           speed = 0;  // of the point: when it closes, how fast; speed 0: not faster than what is left alone
  };
  double leastOf(const Contact& contact, double least) const;
  Approach approach(const Bodies& bodies, const std::vector<Motion>& way, const Contact& contact,
                    const ContactPoint& point, double h, double now, double least) const;
  void schedule(const Bodies& bodies, const std::vector<Motion>& way, const std::vector<Contact*>& contacts,
                int k, double h, double least);
  /// `now`: what was expected comes in, the moment of the impact itself goes out.
  /// False: nothing happened.
  bool strike(Bodies& bodies, Contact& contact, double h, double least, double& now,
              std::vector<Motion>& way);
  Frame frameAt(const Bodies& bodies, const std::vector<Motion>& way, int body, double h, double time) const;
  /// Finds the moment at which the two pieces really meet, near `now`, and their contact then; false: they do
  /// not.
  bool meet(const Bodies& bodies, const std::vector<Motion>& way, Contact& contact, double h,
            double& now) const;
  void push(Bodies& bodies, const Contact& contact, Vec2 armA, Vec2 armB, Vec2 impulse, double time,
            std::vector<Motion>& way);
  Vec2 acceleration(const Bodies& bodies, const Contact& contact) const;
  bool isTied(const Contact& contact) const { return joints_.holds(contact.a) || joints_.holds(contact.b); }
  /// Velocities after an impulse on b, with what joints make of it.
  void pushTied(Bodies& bodies, const Contact& contact, Vec2 armA, Vec2 armB, Vec2 impulse);
  /// How fast b parts from a along d at p, by a unit impulse along e at q.
  double response(Bodies& bodies, const Contact& contact, const ContactPoint& p, Vec2 d,
                  const ContactPoint& q, Vec2 e);

  void remember(const Bodies& bodies, const std::vector<Motion>& way);
  void restore(Bodies& bodies, std::vector<Motion>& way) const;

  JointSet& joints_;
  std::vector<int> together_;   // that the contact at hand changes, if joints hold one of its bodies
  std::vector<Motion> before_;  // their velocities
  std::vector<std::array<Motion, 2>> kept_;  // their velocities and ways before the impact at hand
  Vec2 gravity_;
  long count_ = 0, inStep_ = 0;
  std::vector<double> struckAt_;
  std::vector<int> times_;  // by body: impacts within the sub-step
  std::vector<char> flying_;
  std::vector<Event> heap_;
  std::vector<int> stamps_;
  std::vector<int> firstAt_, nextA_, nextB_;  // lists of contacts at each body
};

}  // namespace smokebox

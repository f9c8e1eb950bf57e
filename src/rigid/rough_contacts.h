// Contacts that a sweep leaves far from settled, and all that share a body with them: those are gone over
// again while the others rest.
#pragma once
#include <vector>

#include "rigid/bodies.h"
#include "rigid/contact.h"

namespace smokebox {

class RoughContacts {
 public:
  /// Of both lists, which stay as they are until the last sweep: those at the bodies of which the last sweep
  /// has changed a contact's relative velocity by `above` or more, m/s.
  void begin(const Bodies& bodies, std::vector<SolvedContact>& some, std::vector<SolvedContact>& others,
             double above);
  /// A sweep over them; then those at bodies where it has changed so much. Gives the largest change, m/s.
  double sweep(Bodies& bodies, double above);
  /// How many the next sweep goes over, and how many there are.
  long size() const { return static_cast<long>(rough_.size()); }
  long all() const { return static_cast<long>(contacts_.size()); }

 private:
  void link(const Bodies& bodies, SolvedContact& contact);
  void heat(const Bodies& bodies, int body);
  /// Lists the contacts at all bodies in hot_.
  void gather();

  std::vector<SolvedContact*> contacts_;
  std::vector<int> first_;  // by body: its last linked side, -1 none; a side: twice the contact, 1 more for b
  std::vector<int> next_;   // by side: the body's next one
  std::vector<char> isHot_;     // by body
  std::vector<char> isListed_;  // by contact
  std::vector<int> hot_, rough_;
};

}  // namespace smokebox

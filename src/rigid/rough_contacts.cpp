#include "rigid/rough_contacts.h"

#include <algorithm>

#include "rigid/contact_sweeps.h"

namespace smokebox {

void RoughContacts::begin(const Bodies& bodies, std::vector<SolvedContact>& some,
                          std::vector<SolvedContact>& others, double above) {
  contacts_.clear();
  next_.clear();
  hot_.clear();
  rough_.clear();
  first_.assign(bodies.count(), -1);
  isHot_.assign(bodies.count(), 0);
  for (std::vector<SolvedContact>* contacts : {&some, &others})
    for (SolvedContact& contact : *contacts)
      if (contact.count > 0) link(bodies, contact);
  isListed_.assign(contacts_.size(), 0);
  for (const SolvedContact* contact : contacts_)
    if (contact->change >= above)
      for (const int body : {contact->a, contact->b}) heat(bodies, body);
  gather();
}

// What nothing moves hands nothing on.
void RoughContacts::link(const Bodies& bodies, SolvedContact& contact) {
  for (const int body : {contact.a, contact.b}) {
    const int side = static_cast<int>(next_.size());
    next_.push_back(first_[body]);
    if (bodies.moves(body)) first_[body] = side;
  }
  contacts_.push_back(&contact);
}

void RoughContacts::heat(const Bodies& bodies, int body) {
  if (isHot_[body] || !bodies.moves(body)) return;
  isHot_[body] = 1;
  hot_.push_back(body);
}

void RoughContacts::gather() {
  rough_.clear();
  for (const int body : hot_) {
    isHot_[body] = 0;
    for (int side = first_[body]; side >= 0; side = next_[side]) {
      const int contact = side / 2;
      if (isListed_[contact]) continue;
      isListed_[contact] = 1;
      rough_.push_back(contact);
    }
  }
  hot_.clear();
  for (const int contact : rough_) isListed_[contact] = 0;
}

double RoughContacts::sweep(Bodies& bodies, double above) {
  double largest = 0;
  for (const int k : rough_) {
    SolvedContact& contact = *contacts_[k];
    largest = std::max(largest, solve(bodies, contact));
    if (contact.change < above) continue;
    for (const int body : {contact.a, contact.b}) heat(bodies, body);
  }
  gather();
  return largest;
}

}  // namespace smokebox

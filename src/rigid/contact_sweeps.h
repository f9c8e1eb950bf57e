// The contact solver one contact at a time, for contacts that are found anew in every sub-step; see
// contact_blocks.h for the method.
#pragma once
#include <vector>

#include "rigid/bodies.h"
#include "rigid/contact.h"

namespace smokebox {

/// Effective masses of all points, from the arms and the normal.
void setMasses(const Bodies& bodies, SolvedContact& contact);
/// Speed at which a point's sides part along the normal, m/s.
double partingSpeed(const Bodies& bodies, const Contact& contact, const ContactPoint& point);
/// How much of a point's gap the bodies' displacements since the step's start make up, m.
double gapMoved(const Bodies& bodies, const Contact& contact, const ContactPoint& point);
/// Adds an impulse along the normal and the tangent to the velocities.
void pushApart(Bodies& bodies, const Contact& contact, const ContactPoint& point, double normal,
               double tangential);
/// Both normal impulses of a contact at once: the 2 x 2 linear complementarity problem by its four cases
/// (Murty; as in Catto's block solver). `k`: the contact's response; `speed`: what each point's parting speed
/// lacks without any impulse.
void solveBoth(const double k[4], const double speed[2], double impulse[2]);

void warmStart(Bodies& bodies, const std::vector<SolvedContact>& contacts);
/// Once before the sweeps of a sub-step: how fast each gap may close.
void prepare(const Bodies& bodies, std::vector<SolvedContact>& contacts, double h);
/// Gives the largest change of a relative velocity, m/s, and notes it in the contact.
double solve(Bodies& bodies, SolvedContact& contact);
/// One sweep; contacts that parted faster than they need by more than `enough`, m/s, are left out.
double solve(Bodies& bodies, std::vector<SolvedContact>& contacts, double enough);
/// Moves what overlaps apart by a share of that, at most `most` metres, on places alone. Gives the deepest
/// overlap before.
double separate(Bodies& bodies, const SolvedContact& contact, double share, double most);

}  // namespace smokebox

// Contacts of pieces that are parts of bodies: only what lies on a body's outline gives a normal.
#pragma once
#include "rigid/contact_points.h"

namespace smokebox::convex {

/// The contact on the outlines' edges alone, taken when corners do not touch each other. `ab` and `ba`: the
/// pair seen from either piece. `separation`: the largest of all edges, those inside the bodies too.
bool collideOutlines(const Side& ab, const Side& ba, double separation, double margin, Manifold& manifold);

}  // namespace smokebox::convex

// Makes the outlines that coverGrid follows: none of them overlap, and each edge knows its solid.
#pragma once
#include "geometry/coverage.h"

namespace smokebox {

/// Fills work.outlines from the solids, grown by `growth` metres; solids whose boxes overlap are merged.
void prepareOutlines(const std::vector<SolidOutline>& solids, double growth, CoverWork& work);

}  // namespace smokebox

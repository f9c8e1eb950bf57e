#include "study/cases.h"

namespace smokebox {

std::vector<Study> allCases() {
  std::vector<Study> all = {driftingVortices(),    vortexPair(),       steadyCylinder(), sheddingCylinder(),
                            oscillatingCylinder(), turningCylinders(), potentialDisk()};
  for (const std::vector<Study>& family :
       {lidDrivenCavities(), mirrorImages(), fluidsAtRest(), heatedCavities()})
    all.insert(all.end(), family.begin(), family.end());
  return all;
}

}  // namespace smokebox

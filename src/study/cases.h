// One function a case, or a family of them, in a file of its own; allCases() lists them.
#pragma once
#include "study/study.h"

namespace smokebox {

Study driftingVortices();
Study vortexPair();
std::vector<Study> lidDrivenCavities();
std::vector<Study> mirrorImages();
std::vector<Study> fluidsAtRest();
std::vector<Study> heatedCavities();
Study steadyCylinder();
Study sheddingCylinder();
Study oscillatingCylinder();
Study turningCylinders();
Study potentialDisk();

std::vector<Study> allCases();

}  // namespace smokebox

// One function a case, in a file of its own or with its like; allCases() lists them.
#pragma once
#include "study/study.h"

namespace smokebox {

Study driftingVortices();

std::vector<Study> allCases();

}  // namespace smokebox

#include "study/cases.h"

namespace smokebox {

std::vector<Study> allCases() { return {driftingVortices()}; }

}  // namespace smokebox

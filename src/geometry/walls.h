// The four sides of the rectangular domain.
#pragma once

namespace smokebox {

enum class WallKind { slip, noSlip, open, inflow, periodic };
enum class Side { left = 0, right = 1, bottom = 2, top = 3 };

}  // namespace smokebox

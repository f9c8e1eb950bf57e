// The forms in which springs, ropes and motors are drawn, and the colours of what has none of its own.
#pragma once
#include <array>
#include <vector>

#include "base/color.h"
#include "geometry/vec2.h"

namespace smokebox {

/// The colour of the k-th body (particle, cloth) that names none.
Color bodyColor(int index);
/// Of a body's outline and mark: its fill with a share of black, or of white where black would not be seen.
Color outlineColor(const Color& fill, double share = 0.5);

/// Of a spring by its tension, N (negative: it is pressed): blue, then `neutral` at rest, then red, as far
/// for a pull as for the same pressure. Two thirds of the way at `usual`, and never quite at its end.
Color tensionColor(double tension, double usual, const Color& neutral);
/// The same in even steps to the ends of a range, low < high; neutral is zero, or the end that is nearest.
Color tensionColor(double tension, const std::array<double, 2>& range, const Color& neutral);

/// A spring's zigzag, in pixels. The wire keeps its length: coils flatten as the spring stretches.
struct Zigzag {
  double straight = 0;   // at each end
  double period = 0;     // of a coil; 0: too small for coils, a straight line
  double amplitude = 0;  // to each side
};
/// `rest` and `length`: of the spring at rest and now; `unit`: of the picture's line widths.
Zigzag zigzag(double rest, double length, double unit);

/// A rope of `length` from a to b that hangs towards `down` (of length 1): a catenary, or a straight line
/// where it is taut. Points lie evenly along it.
std::vector<Vec2> hangingRope(Vec2 a, Vec2 b, double length, Vec2 down);

/// From `fromRad` to `toRad`, x right and y down.
std::vector<Vec2> arc(Vec2 centre, double radius, double fromRad, double toRad);

}  // namespace smokebox

// What the kinds of joint hold, and how fast it changes with the velocities of the two bodies. With the
// anchors p and q of bodies a and b, their arms r and s from the centres of mass, and the joint's line e
// (n = e turned by 90 degrees):
//
//   row      0                    1                    2 ("drive": limits and motor)
//   pin      (q - p).x            (q - p).y            angle of b - angle of a - start
//   weld     (q - p).x            (q - p).y            the same, kept at 0
//   slide    n . (q - p)          angle, kept at 0     e . (q - p)
//   rope                                               |q - p|
//
// Rate of d . (q - p), with d fixed to the world: d . vb + (s x d) wb - d . va - (r x d) wa; where d turns
// with a, its turning adds -((q - p) x d) wa.
#pragma once
#include <array>

#include "rigid/bodies.h"

namespace smokebox {

/// Rate = x vx + y vy + turn w.
struct Jacobian {
  double x = 0, y = 0, turn = 0;
  double rate(const Motion& v) const { return x * v.x + y * v.y + turn * v.turn; }
};

using JointRow = std::array<double, 3>;

struct JointJacobians {
  std::array<Jacobian, 3> a, b;
};

/// Where both bodies are; the world: at 0, not turned.
struct JointPlace {
  Frame a, b;
  double angleA = 0, angleB = 0;
};

/// Rows that are kept at zero come first: how many; drives are apart from them.
int equalities(JointKind kind);
/// Whether row 2 may act one-sidedly, or as a motor.
bool hasDrive(const JointDef& def);
/// Whether this row is about an angle.
bool isAngle(JointKind kind, int row);

JointRow gapsOf(const JointDef& def, double startAngle, const JointPlace& place);
JointJacobians jacobiansOf(const JointDef& def, const JointPlace& place);

}  // namespace smokebox

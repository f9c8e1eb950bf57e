// Elementary functions whose results are the same to the bit on every x86-64 machine. The C library picks
// variants by processor (with fused multiply-add or without), so they must not touch the simulation's state;
// +, -, *, / and sqrt are exact by IEEE 754 and may. Errors are below 2 units in the last place for every
// argument; angles of any size are reduced without drift.
#pragma once

namespace smokebox {

constexpr double kPi = 3.14159265358979323846;

namespace exact {
/// sin(-x) = -sin(x) and cos(-x) = cos(x) to the bit; not a number for an infinite argument.
double sin(double x);
double cos(double x);
double tan(double x);
double exp(double x);
double log(double x);
/// x to a whole power, by repeated squaring; any size, negative too.
double power(double x, long exponent);
}  // namespace exact

constexpr double radians(double degrees) { return degrees * (kPi / 180); }
constexpr double degrees(double angleRad) { return angleRad * (180 / kPi); }

}  // namespace smokebox

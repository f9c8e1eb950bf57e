// Closed outlines with walls thinner than a cell, which move and turn through the grid: no smoke gets out of
// them, and none in. `out` and `in` are exactly 0 as long as cells are told apart by the true regions.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "base/maths.h"
#include "support/stirred_smoke.h"

namespace smokebox {
namespace {

using test::box;
using test::Stirred;

enum class Ring { bars, polygon };

struct Motion {
  double speed = 0;        // cells a step
  double direction = 0.5;  // radians
  double rim = 0;          // speed of the corners by turning, cells a step
  double start = 0.2;      // angle, radians
};

constexpr int kCells = 48, kSteps = 500;
constexpr double kH = 1.0 / kCells, kHalf = 9.3 * kH;

Vec2 turned(Vec2 p, double a) {
  return {std::cos(a) * p.x - std::sin(a) * p.y, std::sin(a) * p.x + std::cos(a) * p.y};
}

// A closed ring that goes through a periodic domain: four solids that overlap at the corners, or a regular
// heptagon with a hole in it.
std::vector<MovingSolid> ringAt(int step, Ring kind, double wall, const Motion& m) {
  MovingSolid s;
  const double travelled = m.speed * kH * step, spin = m.rim * kH / (1.4 * kHalf);
  Vec2 centre{0.5 + std::cos(m.direction) * travelled, 0.5 + std::sin(m.direction) * travelled};
  centre = {centre.x - std::floor(centre.x), centre.y - std::floor(centre.y)};
  s.origin = centre;
  s.velocity = {std::cos(m.direction) * m.speed * kH, std::sin(m.direction) * m.speed * kH};
  s.spin = spin;
  const double a = m.start + spin * step;
  if (kind == Ring::bars) {
    const double w = wall * kH, l = 2 * kHalf + w;
    std::vector<MovingSolid> bars(4, s);
    for (int k = 0; k < 4; ++k) {
      const double side = k % 2 ? kHalf : -kHalf;
      bars[k].outlines = {k < 2 ? box(centre + turned({side, 0}, a), w, l, a)
                                : box(centre + turned({0, side}, a), l, w, a)};
    }
    return bars;
  }
  Outline outer, inner;
  const int sides = 7;
  const double thinner = wall * kH / std::cos(kPi / sides);
  for (int k = 0; k < sides; ++k) {
    outer.push_back(centre + turned({1.2 * kHalf, 0}, a + 2 * kPi * k / sides));
    inner.push_back(centre + turned({1.2 * kHalf - thinner, 0}, a - 2 * kPi * k / sides));
  }
  s.outlines = {outer, inner};
  return {s};
}

// Cells that open faces join with a cell far from the ring.
std::vector<char> outside(const Boundary& b, Vec2 centre) {
  const int n = b.grid.nx;
  auto wrap = [n](int k) { return (k + n) % n; };
  std::vector<char> reached(n * n, 0);
  const int far =
      wrap(static_cast<int>((centre.y + 0.5) * n)) * n + wrap(static_cast<int>((centre.x + 0.5) * n));
  std::vector<int> queue{far};
  reached[far] = 1;
  for (std::size_t head = 0; head < queue.size(); ++head) {
    const int i = queue[head] % n, j = queue[head] / n;
    auto go = [&](int x, int y, float open) {
      const int next = wrap(y) * n + wrap(x);
      if (!(open > 0) || reached[next]) return;
      reached[next] = 1;
      queue.push_back(next);
    };
    go(i - 1, j, b.openX(i, j));
    go(i + 1, j, b.openX(i + 1, j));
    go(i, j - 1, b.openY(i, j));
    go(i, j + 1, b.openY(i, j + 1));
  }
  return reached;
}

struct Leak {
  double out = 0, in = 0;      // shares of what was inside (outside) that are on the other side at the end
  double mass = 0;             // largest relative error of the mass at any step
  double least = 0, most = 0;  // values over all steps
};

Leak leakOf(Ring kind, double wall, const Motion& m) {
  Stirred w(kCells, kCells, kH, ringAt(0, kind, wall, m), 1, WallKind::periodic, 2);
  const std::vector<char> out = outside(w.b, {0.5, 0.5});
  Field inner(kCells, kCells), outer(kCells, kCells);
  for (int j = 0; j < kCells; ++j)
    for (int i = 0; i < kCells; ++i) (out[j * kCells + i] ? outer : inner)(i, j) = 1;
  w.smoke->add(w.b, 0, inner, 1);
  w.smoke->add(w.b, 1, outer, 1);
  Leak leak;
  for (int k = 1; k <= kSteps; ++k) {
    const std::vector<MovingSolid> ring = ringAt(k, kind, wall, m);
    w.step(ring, 1);
    const Smoke::Totals t = w.smoke->totals();
    leak.mass = std::max(leak.mass, std::fabs(t.mass - t.emitted) / t.emitted);
    leak.least = std::min(leak.least, t.min);
    leak.most = std::max(leak.most, t.max);
    if (k < kSteps) continue;
    const std::vector<char> now = outside(w.b, ring[0].origin);
    double wrongOut = 0, allOut = 0, wrongIn = 0, allIn = 0;
    for (int j = 0; j < kCells; ++j)
      for (int i = 0; i < kCells; ++i) {
        const double v = w.b.volume(i, j), a = v * w.smoke->value(0)(i, j), b = v * w.smoke->value(1)(i, j);
        const bool isOut = now[j * kCells + i];
        allOut += a;
        allIn += b;
        wrongOut += isOut ? a : 0;
        wrongIn += isOut ? 0 : b;
      }
    leak.out = wrongOut / allOut;
    leak.in = wrongIn / allIn;
  }
  return leak;
}

void expectTight(Ring kind, double wall, const Motion& m) {
  const Leak leak = leakOf(kind, wall, m);
  std::printf(
      "%s, wall %.2f, speed %.2f at %.2f, rim %.2f: out %.2g, in %.2g, mass %.2g, values %.2g to 1 + %.2g\n",
      kind == Ring::bars ? "bars" : "ring", wall, m.speed, m.direction, m.rim, leak.out, leak.in, leak.mass,
      leak.least, leak.most - 1);
  EXPECT_LE(leak.out, 1e-6);
  EXPECT_LE(leak.in, 1e-6);
  EXPECT_LE(leak.mass, 1e-8);
  EXPECT_GE(leak.least, 0);
  EXPECT_LE(leak.most, 1 + 1e-6);
}

TEST(SmokeLeak, CreepingBoxKeepsItsSmoke) {
  // Nothing passes a closed wall, whatever its thickness: 500 steps, boxes that creep through the grid.
  for (double wall : {0.1, 0.34, 0.9}) expectTight(Ring::bars, wall, {.speed = 0.01});
}
TEST(SmokeLeak, DriftingBoxKeepsItsSmoke) {
  // The same for half a cell a step, along the axes and askew.
  for (double direction : {0.0, 0.6, kPi / 2})
    expectTight(Ring::bars, 0.34, {.speed = 0.5, .direction = direction});
}
TEST(SmokeLeak, FastDriftingRingKeepsItsSmoke) {
  // The same for two cells a step, by which a wall jumps over whole cells.
  expectTight(Ring::bars, 0.1, {.speed = 2});
  expectTight(Ring::polygon, 0.5, {.speed = 2, .direction = 2.2});
}
TEST(SmokeLeak, TurningRingKeepsItsSmoke) {
  // The same for rings that turn in their place, slowly and by two cells a step at the corners.
  expectTight(Ring::polygon, 0.2, {.rim = 0.01});
  expectTight(Ring::bars, 0.2, {.rim = 0.3});
  expectTight(Ring::polygon, 0.34, {.rim = 2});
}
TEST(SmokeLeak, TurningAndDriftingBoxKeepsItsSmoke) {
  // The same for both motions at once.
  expectTight(Ring::bars, 0.1, {.speed = 0.1, .rim = 0.1});
  expectTight(Ring::bars, 0.9, {.speed = 1, .direction = 4, .rim = 0.7});
}

void expectNoCombinationLeaks(Ring kind) {
  for (double wall : {0.1, 0.34, 0.6, 0.9})
    for (double speed : {0.0, 0.01, 0.13, 0.7, 2.0})
      for (double rim : {0.0, 0.01, 0.13, 0.7, 2.0})
        for (double direction : {0.0, 0.6}) {
          if (speed == 0 && (rim == 0 || direction > 0)) continue;
          expectTight(kind, wall, {.speed = speed, .direction = direction, .rim = rim, .start = direction});
        }
}
TEST(SmokeLeakSlow, BarsHoldInAllCombinations) {
  // The same for all speeds, thicknesses and angles: bars that overlap.
  expectNoCombinationLeaks(Ring::bars);
}
TEST(SmokeLeakSlow, RingHoldsInAllCombinations) {
  // And a polygon with a hole.
  expectNoCombinationLeaks(Ring::polygon);
}

}  // namespace
}  // namespace smokebox

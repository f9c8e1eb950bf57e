// What contacts cost: by number of corners, apart or touching; bodies of a thousand corners; times of impact.
// items = pairs.
#include <benchmark/benchmark.h>

#include <array>
#include <vector>

#include "rigid/collide.h"
#include "rigid/collide_bodies.h"
#include "rigid/distance.h"
#include "support/rigid_cases.h"

namespace smokebox {
namespace {

using namespace test;

struct Pair {
  ConvexPiece a, b;
  Frame fa, fb;
};

/// Random pairs that touch (deepest gap within 2% of the size), or that are near but apart.
std::vector<Pair> pairsOf(int na, int nb, bool touching) {
  Dice dice(static_cast<std::uint64_t>(na * 1000 + nb));
  std::vector<Pair> pairs;
  while (pairs.size() < 256) {
    Pair pair{randomPiece(dice, na, na < 3 ? 0.2 : 0), randomPiece(dice, nb, nb < 3 ? 0.2 : 0), dice.frame(2),
              dice.frame(2)};
    const Closest closest = closestPoints(pair.a, pair.fa, pair.b, pair.fb);
    const double wanted = touching ? dice.between(-0.01, 0.005) : dice.between(0.05, 0.5);
    pair.fb.position = pair.fb.position + (wanted - closest.distance) * closest.normal;
    pairs.push_back(std::move(pair));
  }
  return pairs;
}

void BM_Collide(benchmark::State& state) {
  const std::vector<Pair> pairs =
      pairsOf(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)), state.range(2) != 0);
  Manifold manifold;
  int hits = 0;
  for (auto _ : state)
    for (const Pair& pair : pairs) hits += collide(pair.a, pair.fa, pair.b, pair.fb, 0.01, manifold);
  benchmark::DoNotOptimize(hits);
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(pairs.size()));
}

void BM_ClosestPoints(benchmark::State& state) {
  const std::vector<Pair> pairs =
      pairsOf(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)), false);
  double sum = 0;
  for (auto _ : state)
    for (const Pair& pair : pairs) sum += closestPoints(pair.a, pair.fa, pair.b, pair.fb).distance;
  benchmark::DoNotOptimize(sum);
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(pairs.size()));
}

/// range(0): radians that A turns in the sweep.
void BM_TimeOfImpact(benchmark::State& state) {
  const std::vector<Pair> pairs = pairsOf(4, 5, false);
  double sum = 0;
  for (auto _ : state)
    for (const Pair& pair : pairs) {
      const Sweep a{pair.fa, {0.1, 0.1}, static_cast<double>(state.range(0))}, b{pair.fb, {-0.1, 0}, 0.1};
      sum += timeOfImpact(pair.a, a, pair.b, b, 1e-3).value_or(1);
    }
  benchmark::DoNotOptimize(sum);
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(pairs.size()));
}

Outline gear(int teeth, double inner, double outer) {
  Outline outline;
  for (int k = 0; k < 4 * teeth; ++k) {
    const double r = (k + 1) % 4 < 2 ? inner : outer, turn = 2 * kPi * k / (4 * teeth);
    outline.push_back({r * exact::cos(turn), r * exact::sin(turn)});
  }
  return outline;
}

/// Two gears of 4 range(0) corners that mesh: pairs of pieces and all their contacts. points: contacts found.
void BM_Gears(benchmark::State& state) {
  const int teeth = static_cast<int>(state.range(0));
  const double tooth = 2 * kPi / teeth;
  Vec2 offset;
  const BodyShape a = makeBodyShape({PolygonShape{gear(teeth, 1 - 0.5 * tooth, 1)}, {}}, 1e-3, offset);
  const Frame fa{{0, 0}, {}}, fb{{2 - 0.4 * tooth, 0}, turnBy(kPi + tooth / 4)};
  std::vector<PiecePair> pairs;
  Manifold manifold;
  int points = 0;
  for (auto _ : state) {
    points = 0;
    findPiecePairs(a, fa, a, fb, 0.01 * tooth, pairs);
    for (PiecePair pair : pairs)
      if (collide(a.pieces[pair.a], fa, a.pieces[pair.b], fb, 0.01 * tooth, manifold))
        points += manifold.count;
  }
  state.counters["points"] = points;
  state.counters["pairs"] = static_cast<double>(pairs.size());
  state.counters["pieces"] = static_cast<double>(a.pieces.size());
}

void BM_MakeGear(benchmark::State& state) {
  const Outline outline = gear(static_cast<int>(state.range(0)), 0.9, 1);
  Vec2 offset;
  for (auto _ : state)
    benchmark::DoNotOptimize(makeBodyShape({PolygonShape{outline}, {}}, 1e-3, offset).pieces.size());
}

BENCHMARK(BM_Collide)
    ->ArgNames({"na", "nb", "touching"})
    ->ArgsProduct({{1, 2, 4, 8}, {4, 8}, {0, 1}})
    ->Args({3, 5, 1})
    ->Args({64, 4, 1})
    ->Args({64, 64, 1})
    ->Args({1000, 4, 1})
    ->Args({1000, 1000, 1});
BENCHMARK(BM_ClosestPoints)->ArgNames({"na", "nb"})->Args({4, 5})->Args({8, 8})->Args({64, 64});
BENCHMARK(BM_TimeOfImpact)
    ->ArgName("radians")
    ->Arg(0)
    ->Arg(1)
    ->Arg(10)
    ->Arg(600)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(BM_Gears)->ArgName("teeth")->Arg(12)->Arg(50)->Arg(250)->Unit(benchmark::kMicrosecond);
BENCHMARK(BM_MakeGear)->ArgName("teeth")->Arg(12)->Arg(250)->Arg(500)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace smokebox

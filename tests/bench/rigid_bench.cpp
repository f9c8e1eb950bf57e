// A bin of falling and settled polygons against Debian's Box2D 2.4.1, in one run: frames of both in turn, CPU
// time of the thread, no sleeping in either. Then what two bodies of a thousand corners in contact cost.
//
// Prints a table: ms a frame while they fall (the first 3 s), settled (after 6 s) and over all, the ratio,
// the deepest overlap in sizes of a body, and the memory of the bodies.
#include <benchmark/benchmark.h>
#include <box2d/box2d.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <vector>

#include "support/rigid_cases.h"
#include "support/rigid_world.h"

namespace smokebox::test {
namespace {

constexpr double kStep = 1.0 / 60;

double cpuMs() {
  timespec t{};
  if (clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t) != 0) return std::nan("");
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

/// Both simulators with the same polygons: 3 to 8 corners, radius 0.2 to 0.4 m, in rows 0.9 m apart above a
/// floor.
struct BinCase {
  int count = 0;
  bool concave = false;  // every third a star
  double bounce = 0;
  bool withOther = false, otherSweeps = false;  // Box2D; with its swept tests
  int threads = 1;                              // of ours
};

class Bin {
 public:
  explicit Bin(const BinCase& of)
      : count_(of.count),
        width_(std::sqrt(count_) * 0.8),
        world_(walls(count_), {0, -10}, of.threads),
        other_(b2Vec2(0, -10)) {
    const auto [count, concave, bounce, withOther, otherSweeps, threads] = of;
    other_.SetAllowSleeping(false);
    other_.SetContinuousPhysics(otherSweeps);
    Dice dice(1);
    if (withOther) addWalls(4 * std::sqrt(count) * 3);
    const int columns = static_cast<int>(width_ / 0.9);
    for (int k = 0; k < count; ++k) {
      const double x = 0.5 + k % columns * 0.9 + dice.between(-0.02, 0.02), y = 0.5 + k / columns * 0.9;
      const double radius = dice.between(0.2, 0.4), turn = dice.between(0, 2 * kPi);
      const bool star = concave && k % 3 == 0;
      const int corners = star ? 2 * (3 + k / 3 % 3) : 3 + k % 6;
      PolygonShape polygon;
      for (int q = 0; q < corners; ++q) {
        const double angle = turn + 2 * kPi * q / corners, r = star && q % 2 ? 0.45 * radius : radius;
        polygon.points.push_back({r * exact::cos(angle), r * exact::sin(angle)});
      }
      Vec2 offset;
      auto shape = std::make_shared<const BodyShape>(makeBodyShape({polygon, {}}, 1e-3, offset));
      BodyDef def = bodyAt(shape, Vec2{x, y} + offset);
      def.friction = 0.6, def.bounce = bounce;
      world_.add(def);
      size_ += 2 * radius / count;
      if (withOther) addOther(polygon.points, {x, y}, bounce);
    }
  }

  /// One frame of each.
  std::array<double, 2> frame() {
    const double start = cpuMs();
    world_.steps(1);
    const double middle = cpuMs();
    if (other_.GetBodyCount() > 0) other_.Step(static_cast<float>(kStep), 8, 3);
    return {middle - start, cpuMs() - middle};
  }
  void steps(int count) { world_.steps(count); }
  double overlap() const { return world_.system.totals().overlap / size_; }
  double bytesPerBody() const { return static_cast<double>(world_.system.bytes()) / count_; }

 private:
  static RigidWalls walls(int count) {
    RigidWalls walls = closedBox(std::sqrt(count) * 0.8, std::sqrt(count) * 3, 0, 0.6);
    walls.sides[3] = RigidWalls::Kind::open;
    return walls;
  }
  void addWalls(double height) {
    b2BodyDef def;
    b2Body* ground = other_.CreateBody(&def);
    const float w = static_cast<float>(width_), h = static_cast<float>(height);
    const b2Vec2 corners[4] = {{0, h}, {0, 0}, {w, 0}, {w, h}};
    for (int k = 0; k < 3; ++k) {
      b2EdgeShape edge;
      edge.SetTwoSided(corners[k], corners[k + 1]);
      b2FixtureDef fixture;
      fixture.shape = &edge;
      fixture.friction = 0.6f;
      ground->CreateFixture(&fixture);
    }
  }
  void addOther(const std::vector<Vec2>& points, Vec2 at, double bounce) {
    b2BodyDef def;
    def.type = b2_dynamicBody;
    def.position.Set(static_cast<float>(at.x), static_cast<float>(at.y));
    b2Vec2 corners[8];
    for (std::size_t k = 0; k < points.size(); ++k)
      corners[k].Set(static_cast<float>(points[k].x), static_cast<float>(points[k].y));
    b2PolygonShape shape;
    shape.Set(corners, static_cast<int>(points.size()));
    b2FixtureDef fixture;
    fixture.shape = &shape;
    fixture.density = 1;
    fixture.friction = 0.6f;
    fixture.restitution = static_cast<float>(bounce);
    other_.CreateBody(&def)->CreateFixture(&fixture);
  }

  int count_;
  double width_, size_ = 0;
  RigidWorld world_;
  b2World other_;
};

/// range: bodies; 1: a third of them concave (then without Box2D); bounce in tenths; 1: Box2D with its swept
/// tests (its default; ours always has them).
void BM_RigidBin(benchmark::State& state) {
  const int count = static_cast<int>(state.range(0));
  const bool concave = state.range(1) != 0;
  for (auto _ : state) {
    const bool sweeps = state.range(3) != 0;
    Bin bin({count, concave, 0.1 * static_cast<double>(state.range(2)), !concave, sweeps});
    double ms[3][2] = {};  // falling, settled, all; ours, Box2D
    int frames[3] = {};
    double overlap = 0;
    for (int k = 0; k < 480; ++k) {
      const std::array<double, 2> took = bin.frame();
      overlap = std::max(overlap, bin.overlap());
      for (const int phase : {0, 1, 2}) {
        if ((phase == 0 && k >= 180) || (phase == 1 && k < 360)) continue;
        ++frames[phase];
        for (const int who : {0, 1}) ms[phase][who] += took[who];
      }
    }
    state.SetIterationTime(1e-3 * ms[2][0]);
    std::printf("%6d %-8s bounce %.1f%s |", count, concave ? "concave" : "convex",
                0.1 * static_cast<double>(state.range(2)),
                concave || sweeps ? "" : ", Box2D without swept tests");
    const char* names[] = {"falling", "settled", "all"};
    for (const int phase : {0, 1, 2}) {
      const double ours = ms[phase][0] / frames[phase], theirs = ms[phase][1] / frames[phase];
      std::printf(" %s %.3f ms", names[phase], ours);
      if (!concave) std::printf(" : %.3f = %.2f", theirs, ours / theirs);
      std::printf(" |");
    }
    std::printf(" overlap %.2g | %.0f bytes a body\n", overlap, bin.bytesPerBody());
    std::fflush(stdout);
    state.counters["ms"] = ms[2][0] / frames[2];
    state.counters["overlap"] = overlap;
    if (!concave) state.counters["ratio"] = ms[2][0] / ms[2][1];
  }
}

/// Seven seconds of ours alone; range: bodies, threads. How the time grows with the number of bodies.
void BM_RigidBinGrowth(benchmark::State& state) {
  constexpr int kFrames = 420;
  for (auto _ : state) {
    state.PauseTiming();
    Bin bin({static_cast<int>(state.range(0)), false, 0, false, false, static_cast<int>(state.range(1))});
    state.ResumeTiming();
    bin.steps(kFrames);
  }
  state.counters["frames"] = benchmark::Counter(kFrames, benchmark::Counter::kIsIterationInvariantRate);
}

/// Two polygons of range(0) corners each, one at rest on the other; round, or with teeth (1).
void BM_RigidManyCorners(benchmark::State& state) {
  PolygonShape polygon;
  const int corners = static_cast<int>(state.range(0));
  for (int k = 0; k < corners; ++k) {
    const double angle = 2 * kPi * k / corners, r = state.range(1) != 0 && k % 2 ? 0.49 : 0.5;
    polygon.points.push_back({r * exact::cos(angle), r * exact::sin(angle)});
  }
  const auto shape = bodyShape(polygon);
  RigidWorld world(closedBox(1.2, 20, 0, 0.5), {0, -10});
  for (const double y : {0.5, 1.49}) {
    BodyDef def = bodyAt(shape, {0.55 + 0.1 * y, y});
    def.friction = 0.5;
    world.add(def);
  }
  world.seconds(2);
  for (auto _ : state) world.steps(1);
  state.counters["contacts"] = world.system.totals().contacts;
}

BENCHMARK(BM_RigidBin)
    ->ArgNames({"bodies", "concave", "bounce", "swept"})
    ->Args({1000, 0, 0, 1})
    ->Args({1000, 0, 0, 0})
    ->Args({5000, 0, 0, 1})
    ->Args({5000, 0, 0, 0})
    ->Args({10000, 0, 0, 1})
    ->Args({10000, 0, 0, 0})
    ->Args({1000, 1, 0, 0})
    ->Args({5000, 1, 0, 0})
    ->Args({10000, 1, 0, 0})
    ->Iterations(1)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(BM_RigidBinGrowth)
    ->ArgNames({"bodies", "threads"})
    ->ArgsProduct({{1000, 10000}, {1, 2}})
    ->Iterations(1)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(BM_RigidManyCorners)
    ->ArgNames({"corners", "teeth"})
    ->ArgsProduct({{100, 1000}, {0, 1}})
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace smokebox::test

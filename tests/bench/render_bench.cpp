// What a picture costs: CPU time of the whole process (llvmpipe draws with threads of its own), for one frame
// of 1280x720 from 512x288 cells, with one solid and a caption; and of the same as a PNG file.
#include <benchmark/benchmark.h>

#include <cmath>
#include <filesystem>

#include "base/maths.h"
#include "image/png.h"
#include "render/renderer.h"

namespace smokebox {
namespace {

Snapshot wake(int colors, double filledShare) {
  Snapshot snapshot;
  snapshot.grid = {512, 288, 4.0 / 512};
  snapshot.open = Field(512, 288, 1);
  snapshot.pressure = Field(512, 288);
  const Color palette[] = {{1, 0.7f, 0.28f}, {0.33f, 0.73f, 1}, {0.95f, 0.36f, 0.55f}};
  for (int c = 0; c < colors; ++c) {
    snapshot.smoke.push_back({palette[c % 3], Field(512, 288)});
    for (int j = 0; j < static_cast<int>(288 * filledShare); ++j)
      for (int i = 0; i < 512; ++i)
        snapshot.smoke[c].value(i, j) =
            static_cast<float>(0.5 + 0.5 * std::sin(0.05 * i + c) * std::cos(0.07 * j));
  }
  for (int j = 0; j < 288; ++j)
    for (int i = 0; i < 512; ++i)
      snapshot.pressure(i, j) = static_cast<float>(std::sin(0.02 * i) * std::cos(0.03 * j));
  SolidPicture solid;
  Outline circle;
  for (int k = 0; k < 128; ++k)
    circle.push_back({1 + 0.2 * std::cos(2 * kPi * k / 128), 1.1 + 0.2 * std::sin(2 * kPi * k / 128)});
  solid.outlines.push_back(circle);
  snapshot.solids.push_back(solid);
  snapshot.captions = {"Vortices shed by a cylinder"};
  return snapshot;
}

LayerSpec layerOf(LayerKind kind) {
  LayerSpec layer;
  layer.kind = kind;
  return layer;
}

void drawFrames(benchmark::State& state, Snapshot snapshot, std::initializer_list<LayerKind> kinds,
                bool moving) {
  for (const LayerKind kind : kinds) snapshot.view.layers.push_back(layerOf(kind));
  Renderer renderer(1280, 720);
  Image image;
  renderer.draw(snapshot, image);  // compiles the shaders
  for (auto _ : state) {
    if (moving)
      for (Vec2& point : snapshot.solids[0].outlines[0]) point.x += 1e-4;
    renderer.draw(snapshot, image);
    benchmark::DoNotOptimize(image.rgba.data());
  }
}

void emptyFrame(benchmark::State& state) { drawFrames(state, wake(1, 0), {}, false); }
void smokeOfOneColor(benchmark::State& state) {
  drawFrames(state, wake(1, state.range(0) / 100.0),
             {LayerKind::smoke, LayerKind::solids, LayerKind::caption}, false);
}
void smokeOfThreeColors(benchmark::State& state) {
  drawFrames(state, wake(3, state.range(0) / 100.0),
             {LayerKind::smoke, LayerKind::solids, LayerKind::caption}, false);
}
void movingSolid(benchmark::State& state) {
  drawFrames(state, wake(1, 0.5), {LayerKind::smoke, LayerKind::solids, LayerKind::caption}, true);
}
void pressureWithBar(benchmark::State& state) {
  drawFrames(state, wake(1, 0.5), {LayerKind::pressure, LayerKind::solids, LayerKind::caption}, false);
}

/// A heap of small polygons that all move: triangles to hexagons, `radius` pixels large.
void movingPolygons(benchmark::State& state) {
  const int count = static_cast<int>(state.range(0)), columns = 100;
  const double radius = static_cast<double>(state.range(1)) * 4.0 / 1280;
  Snapshot snapshot;
  snapshot.grid = {512, 288, 4.0 / 512};
  const auto place = [&](int k, double time) {
    BodyPicture& body = snapshot.bodies[k];
    body.pose = {{(k % columns + 0.5 + 0.3 * std::sin(time + k)) * 4.0 / columns,
                  (k / columns + 0.5) * 2.25 / (count / columns)},
                 time + k};
    const int sides = 3 + k % 4;
    body.outlines.resize(1);
    body.outlines[0].resize(sides);
    for (int m = 0; m < sides; ++m)
      body.outlines[0][m] =
          transformed(radius * Vec2{std::cos(2 * kPi * m / sides), std::sin(2 * kPi * m / sides)}, body.pose);
  };
  snapshot.bodies.resize(count);
  for (int k = 0; k < count; ++k) snapshot.bodies[k].index = k;
  snapshot.view.layers = {layerOf(LayerKind::bodies)};
  Renderer renderer(1280, 720);
  Image image;
  double time = 0;
  for (int k = 0; k < count; ++k) place(k, time);
  renderer.draw(snapshot, image);
  for (auto _ : state) {
    state.PauseTiming();
    time += 1.0 / 30;
    for (int k = 0; k < count; ++k) place(k, time);
    state.ResumeTiming();
    renderer.draw(snapshot, image);
    benchmark::DoNotOptimize(image.rgba.data());
  }
}

void pngFile(benchmark::State& state) {
  Snapshot snapshot = wake(3, 1);
  snapshot.view.layers = {layerOf(LayerKind::smoke), layerOf(LayerKind::solids)};
  Image image;
  Renderer(1280, 720).draw(snapshot, image);
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "smokebox_render_bench.png";
  for (auto _ : state) writePng(file, image, {});
  std::filesystem::remove(file);
}

BENCHMARK(emptyFrame)->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(smokeOfOneColor)
    ->Arg(30)
    ->Arg(100)
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK(smokeOfThreeColors)
    ->Arg(30)
    ->Arg(100)
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK(movingSolid)->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(pressureWithBar)->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(movingPolygons)
    ->ArgNames({"bodies", "radius"})
    ->Args({5000, 4})
    ->Args({5000, 7})
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK(pngFile)->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace smokebox

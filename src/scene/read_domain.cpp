// domain, walls, time, output, method
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "scene/sections.h"

namespace smokebox {
namespace {

constexpr double kRounding = 1e-6;  // how far a ratio may be from the whole number that it should be

/// Shortest text that reads back as nearly the same number.
std::string shortest(double value, const char* format = "%.10g") {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

std::string memoryText(double bytes) { return shortest(bytes / 1e9, bytes < 1e10 ? "%.1f" : "%.0f") + " GB"; }

/// Is `ratio` a whole number of at least 1, but for rounding?
bool isWhole(double ratio) {
  const double nearest = std::nearbyint(ratio);
  return nearest >= 1 && std::fabs(ratio - nearest) <= kRounding * nearest;
}

/// The fields of the fluid, about; measured over all stages.
constexpr double kBytesPerCell = 200;

double physicalMemory() {
  // Asked for once: it opens a file, and a scene with many events is read many times.
  static const double bytes =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
  return bytes;
}

}  // namespace

void readDomain(MapReader& scene, SceneSpec& spec) {
  Reader& reader = scene.reader();
  const YamlNode* node = scene.required("domain", "such as domain: {size: [4, 2], resolution: 512}");
  spec.domain.grid = {64, 64, 1.0 / 64};  // so that the rest can be checked
  if (!node) return;
  MapReader map(reader, *node, "domain");
  Vec2 size;
  const bool hasSize =
      map.required("size", "width and height in metres") && map.vector("size", size, kPositive);
  constexpr double kMostCells = 1e9;
  double resolution = 0;
  const bool hasResolution =
      map.required("resolution", "cells along x") && map.number("resolution", resolution);
  map.finish();
  if (!hasResolution) return;
  const YamlNode& where = *map.find("resolution");
  if (resolution != std::floor(resolution) || resolution < 8 || resolution > kMostCells) {
    reader.error(where.mark, "`domain.resolution` must be a whole number of at least 8 cells, got " +
                                 where.description());
    return;
  }
  if (!hasSize) return;

  const double h = size.x / resolution, rows = size.y / h;
  const double cells = resolution * rows, needed = kBytesPerCell * cells, there = physicalMemory();
  if (needed > there) {
    const double fits = std::floor(std::sqrt(there / kBytesPerCell / (size.y / size.x)) / 8) * 8;
    reader.error(where.mark,
                 "`domain.resolution` " + shortest(resolution) + " needs about " + memoryText(needed) +
                     " of memory for " + shortest(resolution) + " x " + shortest(std::nearbyint(rows)) +
                     " cells, and this machine has " + memoryText(there),
                 "at most about " + shortest(fits));
    return;
  }
  constexpr double kSmallestCell = 1e-9, kLargestCell = 1e9, kFewestRows = 4;
  if (h < kSmallestCell || h > kLargestCell) {
    reader.error(map.find("size")->mark,
                 "cells of " + shortest(h, "%.3g") + " m; their size must be between 1e-9 and 1e9 m");
    return;
  }
  if (!isWhole(rows)) {
    const double below = std::max(kFewestRows, std::floor(rows)), above = below + 1;
    reader.error(map.find("size")->mark,
                 "the height of `domain.size` is " + shortest(rows, "%.6g") + " cells of " +
                     shortest(h, "%.6g") + " m, and must be a whole number",
                 "sizes that do: [" + shortest(size.x) + ", " + shortest(below * h) + "] or [" +
                     shortest(size.x) + ", " + shortest(above * h) + "]");
    return;
  }
  constexpr double kMostAlong = 1 << 20;
  if (std::nearbyint(rows) < kFewestRows || rows > kMostAlong || resolution > kMostAlong) {
    reader.error(where.mark, "a domain of " + shortest(resolution) + " x " + shortest(std::nearbyint(rows)) +
                                 " cells; the height must have 4 to 1048576 of them, the width 8 to 1048576");
    return;
  }
  spec.domain.grid = {static_cast<int>(resolution), static_cast<int>(std::nearbyint(rows)), h};
}

void readTimeAndOutput(MapReader& scene, SceneSpec& spec) {
  Reader& reader = scene.reader();
  YamlMark where = scene.mark();
  if (const YamlNode* node = scene.find("output")) {
    MapReader map(reader, *node, "output");
    if (const YamlNode* size = map.find("size")) {
      constexpr long kMostPixels = 16384;
      if (reader.isList(*size, "output.size", 2)) {
        const auto width = reader.whole(*size->items[0], "output.size.0", 1, kMostPixels);
        const auto height = reader.whole(*size->items[1], "output.size.1", 1, kMostPixels);
        if (width && height) {
          spec.output.width = static_cast<int>(*width);
          spec.output.height = static_cast<int>(*height);
        }
      }
    }
    if (map.whole("fps", spec.output.fps, 1, 240)) where = map.find("fps")->mark;
    map.finish();
  }

  // Without a step: the one nearest to 1/120 s that fits the frames.
  const int fps = spec.output.fps;
  spec.time.step = 1.0 / (fps * std::max(1.0, std::nearbyint(120.0 / fps)));
  double duration = spec.time.duration;
  YamlMark durationMark = where;
  if (const YamlNode* node = scene.find("time")) {
    MapReader map(reader, *node, "time");
    if (map.number("step", spec.time.step, kPositive)) where = map.find("step")->mark;
    if (map.number("duration", duration, kPositive)) durationMark = map.find("duration")->mark;
    map.finish();
  }
  const double step = spec.time.step, perFrame = 1 / (fps * step);
  if (!isWhole(perFrame) || perFrame > 1e6) {
    const double nearest = std::clamp(std::nearbyint(perFrame), 1.0, 1e6);
    reader.error(where,
                 "a frame (1/" + std::to_string(fps) + " s) is " + shortest(perFrame, "%.6g") + " steps of " +
                     shortest(step) + " s, and must be a whole number of steps, up to a million",
                 "the nearest step that works: 1/" + shortest(nearest * fps) + " s, " + shortest(nearest) +
                     " a frame");
    return;
  }
  spec.time.stepsPerFrame = static_cast<int>(std::nearbyint(perFrame));
  const double steps = duration / step;
  if (!isWhole(steps) || steps > 1e12) {
    const double below = std::max(1.0, std::floor(steps));
    reader.error(durationMark,
                 "`time.duration` is " + shortest(steps) + " steps of " + shortest(step) +
                     " s, and must be a whole number of steps",
                 "nearest: " + shortest(below * step) + " or " + shortest((below + 1) * step));
    return;
  }
  spec.time.duration = duration;
  spec.time.steps = static_cast<long>(std::nearbyint(steps));
}

void readMethod(MapReader& scene, SceneSpec& spec) {
  const YamlNode* node = scene.find("method");
  if (!node) return;
  if (node->kind == YamlNode::Kind::scalar) {
    scene.reader().error(node->mark, "`method` " + node->description() + " is not supported by this version",
                         "a map with tolerance and max_iterations");
    return;
  }
  MapReader map(scene.reader(), *node, "method");
  constexpr NumberRule kTolerance{0, 0.999999, false, "larger than 0 and below 1"};
  map.number("tolerance", spec.method.tolerance, kTolerance);
  map.whole("max_iterations", spec.method.maxIterations, 1, 100000);
  map.finish();
}

}  // namespace smokebox

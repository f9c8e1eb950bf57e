#include "app/scene_file.h"

#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <limits>

#include "world/plan.h"

namespace smokebox {

namespace {

/// Memory that a new process could have, in MB.
double availableMemoryMb() {
  double available = std::numeric_limits<double>::infinity();
  std::ifstream info("/proc/meminfo");
  for (std::string key, unit; info >> key;) {
    double kilobytes = 0;
    if (!(info >> kilobytes)) break;
    if (key == "MemAvailable:") available = kilobytes / 1024;
    std::getline(info, unit);
  }
  rlimit limit = {};
  if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
    available = std::min(available, static_cast<double>(limit.rlim_cur) / (1024 * 1024));
  return available;
}

}  // namespace

SceneDocument loadScene(const std::string& file, const std::vector<std::string>& settings) {
  SceneDocument document = SceneDocument::load(file);
  for (const std::string& setting : settings) {
    const std::size_t equals = setting.find('=');
    document.set(setting.substr(0, equals), setting.substr(equals + 1),
                 SourcePlace{"--set " + setting, 0, 0});
  }
  return document;
}

void refuseTooLarge(const std::vector<SceneSpec>& specs) {
  double needed = 0;
  for (const SceneSpec& spec : specs) needed += planOf(spec).memoryMb;
  const double available = availableMemoryMb();
  if (needed <= available) return;
  const Grid& grid = specs.front().domain.grid;
  char text[200];
  std::snprintf(text, sizeof text, "%s%d x %d cells need about %.0f MB of memory, and %.0f MB are free; %s",
                specs.size() > 1 ? (std::to_string(specs.size()) + " runs of ").c_str() : "", grid.nx,
                grid.ny, needed, available, "lower domain.resolution");
  throw Error(ExitStatus::failed, text);
}

}  // namespace smokebox

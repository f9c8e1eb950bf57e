// The yardstick scene of the benchmarks: a plume of smoke of one colour past a disk, with vorticity
// confinement, in a square box that is open at the top.
#pragma once
#include <chrono>
#include <string>

namespace smokebox::test {

inline std::string plume(int cells, int stepsASecond) {
  return "domain: {size: [1, 1], resolution: " + std::to_string(cells) +
         R"(}
walls: {top: open}
time: {duration: 100, step: 1/)" +
         std::to_string(stepsASecond) + R"(}
gravity: [0, -9.81]
fluid: {vorticity: 0.3}
smoke:
  buoyancy: 0.6
  sources: [{shape: {circle: {center: [0.5, 0.1], radius: 0.05}}, rate: 2}]
solids: [{name: disk, shape: {circle: {radius: 0.1}}, position: [0.52, 0.5]}]
output: {fps: 10}
)";
}

double seconds(const auto& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace smokebox::test

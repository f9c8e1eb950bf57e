// No step allocates once the first ones have found their sizes. Counted by this program's own operator new.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <new>

#include "world/world.h"

namespace {
std::atomic<long> allocations{0};
}  // namespace

// The two of a pair are seen apart where they are inlined.
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"

void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size ? size : 1)) return memory;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  ++allocations;
  const auto unit = static_cast<std::size_t>(alignment);
  if (void* memory = std::aligned_alloc(unit, (size + unit - 1) / unit * unit)) return memory;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {  // stable_sort's
  ++allocations;
  return std::malloc(size);
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

namespace smokebox {
namespace {

/// In 20 steps after the first ones.
long allocationsInSteps(const std::string& scene, int threads, int first = 20) {
  World world(SceneDocument::parse(scene, "scene.yaml"), {.threads = threads});
  for (int k = 0; k < first; ++k) world.step();
  const long before = allocations;
  for (int k = 0; k < 20; ++k) world.step();
  return allocations - before;
}

std::string wind(const std::string& timeStep) {
  return R"yaml(domain: {size: [2, 1], resolution: 64}
walls: {left: {inflow: [1, 0]}, right: open}
output: {fps: 1}
fluid: {vorticity: 0.3, velocity: ["1", "0.2*sin(pi*x)"]}
solids: [{name: disk, shape: {circle: {radius: 0.1}}, position: [0.5, 0.5]}]
time: {duration: 100, step: )yaml" +
         timeStep + "}\n";
}

TEST(Allocation, AStepOfTheVelocityDoesWithout) {
  // Truth: none, for one thread and two, in short steps, sub-steps and huge ones.
  for (const char* timeStep : {"1/100", "1/20", "1/5"})
    for (const int threads : {1, 2}) EXPECT_EQ(allocationsInSteps(wind(timeStep), threads), 0) << timeStep;
}

TEST(Allocation, AStepOfAPlumeDoesWithout) {
  // Truth: none with smoke beside a disk either, once it has been everywhere: lists grow with the smoke.
  for (const char* timeStep : {"1/200", "1/20", "1/5"}) {
    const std::string plume = std::string(R"yaml(domain: {size: [1, 1], resolution: 64}
walls: {top: open}
output: {fps: 1}
fluid: {vorticity: 0.3}
smoke:
  buoyancy: 0.6
  sources: [{shape: {circle: {center: [0.5, 0.1], radius: 0.05}}, rate: 4}]
solids: [{name: disk, shape: {circle: {radius: 0.1}}, position: [0.52, 0.5]}]
time: {duration: 100, step: )yaml") +
                              timeStep + "}\n";
    for (const int threads : {1, 2}) EXPECT_EQ(allocationsInSteps(plume, threads, 400), 0) << timeStep;
  }
}

TEST(Allocation, ViscosityDoesWithout) {
  // Truth: none in a viscous channel.
  const std::string channel = R"(domain: {size: [2, 1], resolution: 64}
walls: {left: {inflow: [1, 0]}, right: open, bottom: no-slip, top: no-slip}
time: {duration: 100, step: 1/60}
output: {fps: 1}
fluid: {viscosity: 1e-3}
solids: [{name: disk, shape: {circle: {radius: 0.1}}, position: [0.5, 0.5]}]
)";
  EXPECT_EQ(allocationsInSteps(channel, 1), 0);
}

TEST(Allocation, HeatDoesWithout) {
  // Truth: none, with a wall whose temperature changes, for one thread and two.
  const std::string heated = R"yaml(domain: {size: [2, 1], resolution: 64}
gravity: [0, -9.81]
time: {duration: 100, step: 1/60}
output: {fps: 1}
temperature: {diffusivity: 1e-3, start: "y > 0.5 ? 1 : 0", expansion: 0.1, walls: {bottom: "3 + sin(t)", top: 0}}
solids: [{name: disk, shape: {circle: {radius: 0.1}}, position: [0.5, 0.5]}]
)yaml";
  for (const int threads : {1, 2}) EXPECT_EQ(allocationsInSteps(heated, threads), 0);
}

}  // namespace
}  // namespace smokebox

#include "app/film_runs.h"

#include <algorithm>
#include <future>
#include <utility>

#include "app/interrupt.h"
#include "app/notices.h"
#include "base/errors.h"
#include "world/world.h"

namespace smokebox {

namespace {

/// Leaves a run because another one has failed: never seen by the user, for the first error is told.
struct OtherFailed {};

void widen(std::array<double, 2>& range, const std::array<double, 2>& by) {
  range = {std::min(range[0], by[0]), std::max(range[1], by[1])};
}

}  // namespace

FilmRanges commonRanges(const std::vector<SceneDocument>& scenes, int threadsEach,
                        const std::function<void(long done, long frames)>& eachFrame) {
  std::atomic<bool> stop{false};
  std::vector<std::future<FilmRanges>> found;
  for (const SceneDocument& scene : scenes)
    found.push_back(std::async(std::launch::async, [&, first = &scene == &scenes.front()] {
      try {
        return findRanges(scene, threadsEach, [&](long done, long frames) {
          throwIfInterrupted();
          if (stop) throw OtherFailed();
          if (first) eachFrame(done, frames);
        });
      } catch (...) {
        stop = true;
        throw;
      }
    }));
  FilmRanges common;
  std::exception_ptr error;
  for (std::size_t k = 0; k < found.size(); ++k) {
    try {
      const FilmRanges ranges = found[k].get();
      if (k == 0) common = ranges;
      widen(common.pressure, ranges.pressure);
      widen(common.vorticity, ranges.vorticity);
      widen(common.speed, ranges.speed);
      widen(common.temperature, ranges.temperature);
    } catch (const OtherFailed&) {
    } catch (...) {
      if (!error) error = std::current_exception();
    }
  }
  if (error) std::rethrow_exception(error);
  return common;
}

FilmRuns::FilmRuns(const std::vector<SceneDocument>& scenes, const std::vector<std::string>& labels,
                   int threadsEach, const FilmRanges& ranges, FilmPipeline& pipeline)
    : pipeline_(pipeline), ranges_(ranges), threadsEach_(threadsEach), orders_(scenes.size()) {
  for (std::size_t k = 0; k < scenes.size(); ++k)
    threads_.emplace_back([this, scene = scenes[k], label = labels[k], panel = static_cast<int>(k)] {
      try {
        run(scene, label, panel);
      } catch (const OtherFailed&) {
      } catch (const SimulationError& error) {
        pipeline_.fail(std::make_exception_ptr(SimulationError(label + ": " + error.what())));
      } catch (...) {
        pipeline_.fail(std::current_exception());
      }
    });
}

FilmRuns::~FilmRuns() {
  stop_ = true;
  for (auto& orders : orders_) orders.breakOff();
  for (std::thread& thread : threads_)
    if (thread.joinable()) thread.join();
}

void FilmRuns::advance(std::unique_ptr<FilmFrame> frame) {
  const auto order = std::make_shared<Order>();
  order->frame = std::move(frame);
  order->missing = static_cast<int>(orders_.size());
  for (auto& orders : orders_) orders.send(order);
}

void FilmRuns::finish() {
  for (auto& orders : orders_) orders.close();
  for (std::thread& thread : threads_) thread.join();
}

void FilmRuns::run(const SceneDocument& scene, const std::string& label, int panel) {
  World world(scene, {.threads = threadsEach_});
  const int stepsPerFrame = world.spec().time.stepsPerFrame;
  while (const auto order = orders_[panel].receive()) {
    FilmFrame& frame = *(*order)->frame;
    while (world.stepCount() < frame.number * stepsPerFrame) {
      throwIfInterrupted();
      if (stop_) throw OtherFailed();
      world.step();
      printNotices(world.takeNotices(), label);
    }
    Snapshot& snapshot = frame.panels[panel];
    world.capture(snapshot);
    ranges_.put(snapshot);
    // Whoever is last here has all earlier frames behind it, and so has every other run: the order is kept.
    if (--(*order)->missing == 0) pipeline_.submit(std::move((*order)->frame));
  }
}

}  // namespace smokebox

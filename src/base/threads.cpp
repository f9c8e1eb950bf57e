#include "base/threads.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>

namespace smokebox {

// One loop at a time. Workers spin for a moment before they sleep: a step is a long row of short loops, and
// waking a sleeping thread costs more than most of them. The caller waits only for workers that have joined
// the loop, so that a worker which the system has put aside (the cores also draw and encode) never holds up a
// loop that is done.
struct ThreadPool::State {
  // `ticket`: generation of the loop, whether it may still be joined, and how many workers are in it.
  static constexpr std::uint64_t kActive = 0xffff, kOpen = 0x10000;
  static constexpr int kGenerationShift = 17;
  static constexpr int kSpins = 1000;

  /// A thread's own part of a loop: it begins there, and then helps the others. What one loop has left in a
  /// core's cache the next one finds there.
  struct alignas(64) Part {
    std::atomic<int> next{0};
    int end = 0;
  };

  std::atomic<std::uint64_t> ticket{0};
  std::atomic<int> sleepers{0};
  std::atomic<bool> stop{false};
  std::vector<Part> parts;  // by thread; the caller's is the first
  Call call = nullptr;
  void* context = nullptr;
  std::exception_ptr error;
  std::mutex errorMutex, sleepMutex;
  std::condition_variable wake;
  std::vector<std::thread> workers;

  explicit State(int threads) : parts(threads) {}

  void cut(int count) {
    const auto n = static_cast<std::int64_t>(parts.size());
    for (std::int64_t k = 0; k < n; ++k) {
      parts[k].next.store(static_cast<int>(count * k / n), std::memory_order_relaxed);
      parts[k].end = static_cast<int>(count * (k + 1) / n);
    }
  }

  void work(std::size_t thread) {
    for (std::size_t k = 0; k < parts.size(); ++k) workOn(parts[(thread + k) % parts.size()]);
  }

  void workOn(Part& part) {
    for (;;) {
      const int block = part.next.fetch_add(1, std::memory_order_relaxed);
      if (block >= part.end) return;
      try {
        call(context, block);
      } catch (...) {
        const std::lock_guard lock(errorMutex);
        if (!error) error = std::current_exception();
      }
    }
  }

  bool isNew(std::uint64_t t, std::uint64_t seen) const {
    return (t & kOpen) != 0 && t >> kGenerationShift != seen;
  }

  void serve(std::size_t thread) {
    std::uint64_t seen = 0;
    while (!stop.load()) {
      std::uint64_t t = ticket.load();
      for (int spin = 0; spin < kSpins && !isNew(t, seen) && !stop.load(std::memory_order_relaxed); ++spin) {
        __builtin_ia32_pause();
        t = ticket.load();
      }
      if (!isNew(t, seen)) {
        std::unique_lock lock(sleepMutex);
        ++sleepers;
        wake.wait(lock, [&] { return stop.load() || isNew(ticket.load(), seen); });
        --sleepers;
        continue;
      }
      if (!ticket.compare_exchange_weak(t, t + 1)) continue;
      seen = t >> kGenerationShift;
      work(thread);
      ticket.fetch_sub(1);
    }
  }

  void wakeSleepers() {
    if (sleepers.load() == 0) return;
    { const std::lock_guard lock(sleepMutex); }
    wake.notify_all();
  }
};

ThreadPool::ThreadPool(int threads)
    : threads_(std::max(1, threads)), state_(std::make_unique<State>(std::max(1, threads))) {
  for (int k = 1; k < threads_; ++k)
    state_->workers.emplace_back([this, k] { state_->serve(static_cast<std::size_t>(k)); });
}

ThreadPool::~ThreadPool() {
  state_->stop = true;
  { const std::lock_guard lock(state_->sleepMutex); }
  state_->wake.notify_all();
  for (std::thread& worker : state_->workers) worker.join();
}

void ThreadPool::runRaw(int count, Call call, void* context) {
  State& s = *state_;
  s.call = call;
  s.context = context;
  s.error = nullptr;
  s.cut(count);
  const std::uint64_t generation = (s.ticket.load() >> State::kGenerationShift) + 1;
  s.ticket.store(generation << State::kGenerationShift | State::kOpen);
  s.wakeSleepers();
  s.work(0);
  s.ticket.fetch_and(~State::kOpen);
  for (int spin = 0; (s.ticket.load() & State::kActive) != 0; ++spin) {
    if (spin < State::kSpins)
      __builtin_ia32_pause();
    else
      std::this_thread::yield();
  }
  if (s.error) std::rethrow_exception(s.error);
}

int hardwareThreads() { return static_cast<int>(std::max(1u, std::thread::hardware_concurrency())); }

}  // namespace smokebox

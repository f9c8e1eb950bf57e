#include "base/threads.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

namespace smokebox {

// One loop at a time. Workers spin for a moment before they sleep: a step is a long row of short loops, and waking a
// sleeping thread costs more than most of them.
struct ThreadPool::State {
  std::mutex mutex;
  std::condition_variable wake;
  std::atomic<unsigned> generation{0};
  std::atomic<int> next{0}, busy{0};
  int count = 0;
  Call call = nullptr;
  void* context = nullptr;
  std::exception_ptr error;
  std::mutex errorMutex;
  bool stop = false;
  std::vector<std::thread> workers;

  void work() {
    for (;;) {
      const int block = next.fetch_add(1, std::memory_order_relaxed);
      if (block >= count) return;
      try {
        call(context, block);
      } catch (...) {
        const std::lock_guard lock(errorMutex);
        if (!error) error = std::current_exception();
      }
    }
  }

  void serve() {
    unsigned seen = 0;
    for (;;) {
      for (int spin = 0; spin < 4000 && generation.load(std::memory_order_acquire) == seen; ++spin) __builtin_ia32_pause();
      if (generation.load(std::memory_order_acquire) == seen) {
        std::unique_lock lock(mutex);
        wake.wait(lock, [&] { return generation.load(std::memory_order_acquire) != seen; });
      }
      seen = generation.load(std::memory_order_acquire);
      if (stop) return;
      work();
      busy.fetch_sub(1, std::memory_order_release);
    }
  }
};

ThreadPool::ThreadPool(int threads) : threads_(std::max(1, threads)), state_(std::make_unique<State>()) {
  for (int k = 1; k < threads_; ++k) state_->workers.emplace_back([this] { state_->serve(); });
}

ThreadPool::~ThreadPool() {
  {
    const std::lock_guard lock(state_->mutex);
    state_->stop = true;
    state_->generation.fetch_add(1, std::memory_order_release);
  }
  state_->wake.notify_all();
  for (std::thread& worker : state_->workers) worker.join();
}

void ThreadPool::runRaw(int count, Call call, void* context) {
  State& s = *state_;
  {
    const std::lock_guard lock(s.mutex);
    s.count = count;
    s.call = call;
    s.context = context;
    s.error = nullptr;
    s.next.store(0, std::memory_order_relaxed);
    s.busy.store(threads_ - 1, std::memory_order_relaxed);
    s.generation.fetch_add(1, std::memory_order_release);
  }
  s.wake.notify_all();
  s.work();
  for (int spin = 0; s.busy.load(std::memory_order_acquire) != 0; ++spin) {
    if (spin < 4000)
      __builtin_ia32_pause();
    else
      std::this_thread::yield();
  }
  if (s.error) std::rethrow_exception(s.error);
}

int hardwareThreads() { return std::max(1u, std::thread::hardware_concurrency()); }

}  // namespace smokebox

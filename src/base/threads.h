// A pool of threads for loops whose iterations write disjoint outputs. Results never depend on the number of
// threads: the loop is cut into the same blocks whatever the pool's size, and sums are joined block by block
// in order.
#pragma once
#include <functional>
#include <memory>
#include <vector>

namespace smokebox {

class ThreadPool {
 public:
  /// `threads` workers in all, the caller among them; at least 1.
  explicit ThreadPool(int threads);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  int threads() const { return threads_; }

  /// Calls body(begin, end) for consecutive blocks of `grain` indices that cover [first, last). Blocks until
  /// all are done; the first exception is passed on. Not reentrant.
  template <class Body>
  void blocks(int first, int last, int grain, Body&& body) {
    if (last <= first) return;
    const int count = (last - first + grain - 1) / grain;
    auto one = [&](int block) {
      const int begin = first + block * grain;
      body(begin, begin + grain < last ? begin + grain : last);
    };
    run(count, one);
  }

  /// Sum of body(begin, end) over blocks of `grain`, added in the order of the blocks.
  template <class Body>
  double sum(int first, int last, int grain, Body&& body) {
    if (last <= first) return 0;
    reserve(partial_, (last - first + grain - 1) / grain);
    blocks(first, last, grain,
           [&](int begin, int end) { partial_[(begin - first) / grain] = body(begin, end); });
    double total = 0;
    for (int k = 0, n = (last - first + grain - 1) / grain; k < n; ++k) total += partial_[k];
    return total;
  }

  /// Largest of body(begin, end) over blocks of `grain`; `lowest` where there is none.
  template <class Body>
  double max(int first, int last, int grain, double lowest, Body&& body) {
    if (last <= first) return lowest;
    reserve(partial_, (last - first + grain - 1) / grain);
    blocks(first, last, grain,
           [&](int begin, int end) { partial_[(begin - first) / grain] = body(begin, end); });
    double largest = lowest;
    for (int k = 0, n = (last - first + grain - 1) / grain; k < n; ++k)
      if (partial_[k] > largest || partial_[k] != partial_[k])
        largest = partial_[k];  // a NaN, once there, stays
    return largest;
  }

 private:
  struct State;
  using Call = void (*)(void* context, int block);
  void runRaw(int count, Call call, void* context);
  template <class One>
  void run(int count, One& one) {
    if (threads_ == 1 || count == 1) {
      for (int k = 0; k < count; ++k) one(k);
      return;
    }
    runRaw(
        count, [](void* context, int block) { (*static_cast<One*>(context))(block); }, &one);
  }
  static void reserve(std::vector<double>& v, std::size_t n) {
    if (v.size() < n) v.resize(n);
  }

  int threads_;
  std::unique_ptr<State> state_;
  std::vector<double> partial_;
};

/// The number of hardware threads, at least 1.
int hardwareThreads();

}  // namespace smokebox

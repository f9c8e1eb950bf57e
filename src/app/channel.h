// A queue of few places between two threads.
#pragma once
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>

namespace smokebox {

template <class T>
class Channel {
 public:
  /// Never waits: who sends owns a limited number of things to send.
  void send(T value) {
    {
      const std::lock_guard lock(mutex_);
      queue_.push_back(std::move(value));
    }
    changed_.notify_one();
  }

  /// Waits for something to come. Nothing if the channel is broken, or closed and empty.
  std::optional<T> receive() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return broken_ || closed_ || !queue_.empty(); });
    if (broken_ || queue_.empty()) return std::nullopt;
    std::optional<T> value(std::move(queue_.front()));
    queue_.pop_front();
    return value;
  }

  /// Nothing more will be sent; what is there is still received.
  void close() { set(closed_); }
  /// Whoever waits is let go with nothing.
  void breakOff() { set(broken_); }
  bool broken() const {
    const std::lock_guard lock(mutex_);
    return broken_;
  }

 private:
  void set(bool& flag) {
    {
      const std::lock_guard lock(mutex_);
      flag = true;
    }
    changed_.notify_all();
  }

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<T> queue_;
  bool closed_ = false, broken_ = false;
};

}  // namespace smokebox

#include "app/interrupt.h"

#include <atomic>
#include <csignal>

#include "base/errors.h"

namespace smokebox {

namespace {

// The one thing that a signal handler can reach: it has no argument of its own.
std::atomic<bool> interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free);

}  // namespace

void catchInterrupts() {
  struct sigaction action = {};
  action.sa_handler = [](int) { interrupted = true; };
  action.sa_flags = SA_RESETHAND;  // the second signal has its usual effect
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

void throwIfInterrupted() {
  if (interrupted) throw Interrupted();
}

}  // namespace smokebox

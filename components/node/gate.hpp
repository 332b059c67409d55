#pragma once
#include <atomic>
#include <exception>
#include <mutex>

#include "components/node/wake.hpp"

/// Lets handlers run on DDS's own thread, where a message arrives, one at a time with the loop's
/// timers: a hop then costs one wake-up instead of two.
namespace node {

class Gate {
 public:
  explicit Gate(Wake& wake) : wake_(wake) {}

  /// Until then, and after closing, an arrival only wakes the loop.
  void open() { open_ = true; }
  /// Waits for a handler that runs now; none begins afterwards.
  void close() {
    const std::lock_guard lock(mutex_);
    open_ = false;
  }
  /// From DDS's thread. What `handle` throws is kept for the loop.
  template <class Handle>
  void enter(Handle&& handle) {
    if (!open_) return wake_.raise();
    const std::lock_guard lock(mutex_);
    if (!open_) return;
    try {
      handle();
    } catch (...) {
      error_ = std::current_exception();
      open_ = false;
      wake_.raise();
    }
  }
  /// From the loop, held while it runs timers and descriptors.
  std::unique_lock<std::recursive_mutex> lock() { return std::unique_lock(mutex_); }
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  Wake& wake_;
  std::recursive_mutex mutex_;  ///< a handler may publish what its own process reads
  std::atomic<bool> open_ = false;
  std::exception_ptr error_;
};

}  // namespace node

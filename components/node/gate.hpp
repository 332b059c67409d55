#pragma once
#include <atomic>
#include <exception>
#include <mutex>

#include "components/node/wake.hpp"

/// Mutual exclusion between handlers, which run on DDS's thread when a message arrives, and the
/// timers of the main loop. One hop then costs one wake-up instead of two.
namespace node {

class Gate {
 public:
  explicit Gate(Wake& wake) : wake_(wake) {}

  /// Before `open` and after `close`, an arriving message only wakes the main loop.
  void open() { open_ = true; }
  /// Waits for a running handler; no handler starts afterwards.
  void close() {
    const std::lock_guard lock(mutex_);
    open_ = false;
  }
  /// Calls `handle` on DDS's thread. Stores its exception for `rethrow` in the main loop.
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
  /// The main loop holds this lock while it runs timers and descriptor handlers.
  std::unique_lock<std::recursive_mutex> lock() { return std::unique_lock(mutex_); }
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  Wake& wake_;
  std::recursive_mutex mutex_;  ///< recursive: a handler may publish to a reader of its own process
  std::atomic<bool> open_ = false;
  std::exception_ptr error_;
};

}  // namespace node

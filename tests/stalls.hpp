#pragma once
#include <pthread.h>
#include <time.h>
#include <catch2/catch.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

/// Detects when the computer itself stalls during a run in real time. The host of a virtual machine
/// may stop one or all of its processors for some time, and then no program on it meets its
/// deadlines.
namespace tests {

inline std::int64_t wall_ns() {
  return std::chrono::system_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

/// Wakes every millisecond on every processor and records delayed wake-ups as stalls. It runs at
/// real-time priority if that is permitted; otherwise other load of the computer also counts as a
/// stall.
class Stalls {
 public:
  /// The instance of this program; it records from the first call on.
  static Stalls& watch() {
    static Stalls stalls;
    return stalls;
  }
  ~Stalls() {
    end_ = true;
    for (std::thread& thread : threads_) thread.join();
  }
  Stalls(const Stalls&) = delete;
  Stalls& operator=(const Stalls&) = delete;

  /// Sum of the stalls of all processors that overlap this interval, in ms. Times are ns since
  /// 1970. A tick counter is delayed by about this sum.
  double sum_of_stalls_ms(std::int64_t from_ns, std::int64_t to_ns) const {
    const std::lock_guard lock(guard_);
    return sum_ms(from_ns, to_ns);
  }
  /// Largest sum within 100 ms.
  double largest_ms(std::int64_t from_ns, std::int64_t to_ns) const {
    const std::lock_guard lock(guard_);
    double largest_ms = 0;
    for (const Stall& stall : stalls_)
      if (stall.to_ns >= from_ns && stall.from_ns <= to_ns)
        largest_ms = std::max(largest_ms, sum_ms(stall.from_ns, stall.from_ns + 100 * ms));
    return largest_ms;
  }

 private:
  struct Stall {
    std::int64_t from_ns, to_ns;
  };
  static constexpr std::int64_t ms = 1'000'000;

  double sum_ms(std::int64_t from_ns, std::int64_t to_ns) const {
    double sum_ms = 0;
    for (const Stall& stall : stalls_)
      if (stall.to_ns >= from_ns && stall.from_ns <= to_ns)
        sum_ms += 1e-6 * double(stall.to_ns - stall.from_ns);
    return sum_ms;
  }

  Stalls() {
    for (unsigned k = 0; k < std::thread::hardware_concurrency(); ++k)
      threads_.emplace_back([this, k] { record(k); });
  }
  void record(unsigned processor) {
    cpu_set_t affinity;
    CPU_ZERO(&affinity);
    CPU_SET(processor, &affinity);
    pthread_setaffinity_np(pthread_self(), sizeof affinity, &affinity);
    const sched_param priority{.sched_priority = 90};
    pthread_setschedparam(pthread_self(), SCHED_FIFO, &priority);
    for (auto last_ns = wall_ns(); !end_;) {
      const timespec pause{0, ms};
      nanosleep(&pause, nullptr);
      const auto now_ns = wall_ns();
      if (const auto due_ns = last_ns + ms; now_ns - due_ns > ms / 2) {
        const std::lock_guard lock(guard_);
        stalls_.push_back({due_ns, now_ns});
      }
      last_ns = now_ns;
    }
  }

  mutable std::mutex guard_;
  std::vector<Stall> stalls_;
  std::atomic<bool> end_ = false;
  std::vector<std::thread> threads_;  // last, because the threads use the other members
};

/// Reports that `what` could not be evaluated on this computer; `tests/run.sh` repeats the line at
/// its end.
inline void not_evaluated(const std::string& what) {
  std::printf("not evaluated, because the computer stalled in every attempt: %s\n", what.c_str());
  std::fflush(stdout);
}

/// Violated requirements of a run; empty if there are none.
using Findings = std::vector<std::string>;

constexpr double tolerated_stall_ms = 8;  // chosen: control loops tolerate it, within 100 ms

/// Performs a run in real time. A run that fails is repeated if the computer stalled for longer
/// than control loops tolerate, 8 ms within 100 ms. After five such runs the test is reported as
/// not evaluated.
template <class Run>
void in_real_time(Run run) {
  for (int remaining_runs = 4;; --remaining_runs) {
    Stalls& stalls = Stalls::watch();
    const auto from_ns = wall_ns();
    const Findings errors = run();
    const double stalled_ms = stalls.largest_ms(from_ns, wall_ns());
    if (!errors.empty())
      std::printf("%s\nlargest stall of the computer within 100 ms: %.1f ms\n", errors[0].c_str(),
                  stalled_ms);
    if (errors.empty() || stalled_ms < tolerated_stall_ms) {
      CHECK(errors == Findings{});
      return;
    }
    if (remaining_runs == 0) return not_evaluated(errors[0]);
    std::printf("%s\nthe computer stalled for %.0f ms: repeating the run\n", errors[0].c_str(),
                stalled_ms);
    std::fflush(stdout);
  }
}

}  // namespace tests

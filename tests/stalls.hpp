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

/// Detects when the computer itself stalls during a run in real time. A virtual machine now and then stops one processor or
/// all of them, and no program on it can keep time then.
namespace tests {

inline std::int64_t wall_ns() {
  return std::chrono::system_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

/// Wakes every millisecond, on every processor, and records the times at which it woke late. It runs at real-time
/// priority where that is permitted; elsewhere other load of the computer counts as a stall as well.
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

  /// Sum of the stalls of all processors that overlap this interval, in ms. Times are ns since 1970. A tick counter is
  /// late by about that much.
  double sum_of_stalls_ms(std::int64_t from_ns, std::int64_t to_ns) const {
    const std::lock_guard lock(guard_);
    return sum_ms(from_ns, to_ns);
  }
  /// Largest sum within 100 ms.
  double largest_ms(std::int64_t from_ns, std::int64_t to_ns) const {
    const std::lock_guard lock(guard_);
    double largest_ms = 0;
    for (const Stall& stall : found_)
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
    for (const Stall& stall : found_)
      if (stall.to_ns >= from_ns && stall.from_ns <= to_ns)
        sum_ms += 1e-6 * double(stall.to_ns - stall.from_ns);
    return sum_ms;
  }

  Stalls() {
    for (unsigned k = 0; k < std::thread::hardware_concurrency(); ++k)
      threads_.emplace_back([this, k] { record(k); });
  }
  void record(unsigned processor) {
    cpu_set_t only;
    CPU_ZERO(&only);
    CPU_SET(processor, &only);
    pthread_setaffinity_np(pthread_self(), sizeof only, &only);
    const sched_param ahead{.sched_priority = 90};
    pthread_setschedparam(pthread_self(), SCHED_FIFO, &ahead);
    for (auto last_ns = wall_ns(); !end_;) {
      const timespec pause{0, ms};
      nanosleep(&pause, nullptr);
      const auto now_ns = wall_ns();
      if (const auto due_ns = last_ns + ms; now_ns - due_ns > ms / 2) {
        const std::lock_guard lock(guard_);
        found_.push_back({due_ns, now_ns});
      }
      last_ns = now_ns;
    }
  }

  mutable std::mutex guard_;
  std::vector<Stall> found_;
  std::atomic<bool> end_ = false;
  std::vector<std::thread> threads_;  // last: they use the others
};

/// Reports that this computer could not evaluate `what`; `tests/run.sh` repeats the line at its end.
inline void not_evaluated(const std::string& what) {
  std::printf("not evaluated, because the computer stalled in every attempt: %s\n", what.c_str());
  std::fflush(stdout);
}

/// Errors of a run; empty: none.
using Complaints = std::vector<std::string>;

/// A run in real time. A run that fails is repeated if the computer stalled for longer than control loops tolerate, 8 ms
/// within 100 ms. After five such runs the test is reported as not evaluated.
template <class Run>
void in_real_time(Run run) {
  for (int left = 4;; --left) {
    Stalls& stalls = Stalls::watch();
    const auto from_ns = wall_ns();
    const Complaints errors = run();
    const double stalled_ms = stalls.largest_ms(from_ns, wall_ns());
    if (!errors.empty())
      std::printf("%s\nlargest stall of the computer within 100 ms: %.1f ms\n", errors[0].c_str(),
                  stalled_ms);
    if (errors.empty() || stalled_ms < 8) {
      CHECK(errors == Complaints{});
      return;
    }
    if (left == 0) return not_evaluated(errors[0]);
    std::printf("%s\nthe computer stalled for %.0f ms: repeating the run\n", errors[0].c_str(),
                stalled_ms);
    std::fflush(stdout);
  }
}

}  // namespace tests

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

/// What the machine itself does to a run in real time: a virtual one stands still now and then, one
/// processor or all, and nobody on it can keep time then.
namespace tests {

inline std::int64_t wall_ns() {
  return std::chrono::system_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

/// Looks each millisecond, on every processor and ahead of everything else (where that is permitted:
/// elsewhere what else the machine does counts as well), for times at which it could not.
class Stalls {
 public:
  /// The one of this program; it looks from the first call on.
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

  /// All that overlap these times (since 1970), of every processor, together, ms: what is counted in
  /// ticks is late by about that much.
  double together_ms(std::int64_t from_ns, std::int64_t to_ns) const {
    const std::lock_guard lock(guard_);
    return sum_ms(from_ns, to_ns);
  }
  /// The most of that in a tenth of a second.
  double most_ms(std::int64_t from_ns, std::int64_t to_ns) const {
    const std::lock_guard lock(guard_);
    double most_ms = 0;
    for (const Stall& stall : found_)
      if (stall.to_ns >= from_ns && stall.from_ns <= to_ns)
        most_ms = std::max(most_ms, sum_ms(stall.from_ns, stall.from_ns + 100 * ms));
    return most_ms;
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
      threads_.emplace_back([this, k] { look(k); });
  }
  void look(unsigned processor) {
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

/// Says that this machine is no judge of that; `tests/run.sh` tells it again at its end.
inline void not_evaluated(const std::string& what) {
  std::printf("not judged, the machine stood still each time: %s\n", what.c_str());
  std::fflush(stdout);
}

/// What is wrong with a run; nothing where it is empty.
using Complaints = std::vector<std::string>;

/// A run in real time. One that fails is made again if the machine stood still in it for longer than
/// loops bear, 8 ms in a tenth of a second; where that was so five times it is not judged.
template <class Run>
void in_real_time(Run run) {
  for (int left = 4;; --left) {
    Stalls& stalls = Stalls::watch();
    const auto from_ns = wall_ns();
    const Complaints wrong = run();
    const double still_ms = stalls.most_ms(from_ns, wall_ns());
    if (wrong.empty() || still_ms < 8) {
      CHECK(wrong == Complaints{});
      return;
    }
    if (left == 0) return not_evaluated(wrong[0]);
    std::printf("%s\nthe machine stood still for %.0f ms: once more\n", wrong[0].c_str(), still_ms);
    std::fflush(stdout);
  }
}

}  // namespace tests

#pragma once
#include <atomic>
#include <chrono>
#include <iostream>
#include <thread>

#include "components/node/real_time.hpp"

/// What the machine itself does to a run in real time: a virtual one stands still now and then, and
/// nobody in it can keep time then.
namespace tests {

using namespace std::chrono_literals;

class Stalls {
 public:
  Stalls()
      : watch_([this] {
          const node::RealTime urgent(true);
          for (auto last = Clock::now(); !end_;) {
            std::this_thread::sleep_for(1ms);
            const auto now = Clock::now();
            longest_ = std::max(longest_.load(), now - last), last = now;
          }
        }) {}
  ~Stalls() { end_ = true, watch_.join(); }
  Stalls(const Stalls&) = delete;
  Stalls& operator=(const Stalls&) = delete;

  std::chrono::duration<double, std::milli> longest() const { return longest_.load(); }

 private:
  using Clock = std::chrono::steady_clock;
  std::atomic<bool> end_ = false;
  std::atomic<Clock::duration> longest_ = Clock::duration::zero();
  std::thread watch_;  // last: it uses the others
};

/// A run in real time, made again while the machine stood still in it for longer than loops bear;
/// five times at most, then the last one counts.
template <class Run>
void in_real_time(Run run) {
  for (int left = 4;; --left) {
    const Stalls stalls;
    auto judge = run();
    if (stalls.longest() < 8ms || left == 0) return judge();
    std::cout << "the machine stood still for " << stalls.longest().count() << " ms: once more\n";
  }
}

}  // namespace tests

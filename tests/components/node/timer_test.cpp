#include "components/node/timer.hpp"

#include <catch2/catch.hpp>
#include <vector>

using node::Timer;

namespace {

constexpr std::int64_t period_ns = 2000;

/// The moments of the calls until `end_ns`, when none can be made before `free_ns`.
std::vector<std::int64_t> calls(Timer timer, std::int64_t free_ns, std::int64_t end_ns,
                                std::int64_t& left_out) {
  std::vector<std::int64_t> moments;
  for (auto now_ns = std::max(free_ns, timer.next_ns()); now_ns <= end_ns;
       now_ns = std::max(free_ns, timer.next_ns())) {
    moments.push_back(now_ns);
    left_out += timer.take(now_ns);
  }
  return moments;
}

}  // namespace

TEST_CASE("calls in time are one a period") {
  std::int64_t left_out = 0;
  CHECK(calls(Timer(period_ns, 0, 0), 0, 8000, left_out) ==
        std::vector<std::int64_t>{2000, 4000, 6000, 8000});
  CHECK(left_out == 0);
}

TEST_CASE("late calls are made up at twice the rate, then the clock is kept again") {
  std::int64_t left_out = 0;
  CHECK(calls(Timer(period_ns, 10000, 0), 7500, 14000, left_out) ==
        std::vector<std::int64_t>{7500, 8500, 9500, 10500, 11500, 12500, 14000});
  CHECK(left_out == 0);
}

TEST_CASE("what is later than can be made up is left out and counted") {
  std::int64_t left_out = 0;
  CHECK(calls(Timer(period_ns, 0, 0), 9000, 12000, left_out) ==
        std::vector<std::int64_t>{9000, 10000, 12000});
  CHECK(left_out == 3);
}

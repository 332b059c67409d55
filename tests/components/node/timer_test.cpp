#include "components/node/timer.hpp"

#include <catch2/catch.hpp>
#include <vector>

using node::Timer;

namespace {

constexpr std::int64_t period_ns = 2000;

/// The times of the calls until `end_ns` if no call is possible before `free_ns`.
std::vector<std::int64_t> calls(Timer timer, std::int64_t free_ns, std::int64_t end_ns,
                                std::int64_t& skipped) {
  std::vector<std::int64_t> times_ns;
  for (auto now_ns = std::max(free_ns, timer.next_ns()); now_ns <= end_ns;
       now_ns = std::max(free_ns, timer.next_ns())) {
    times_ns.push_back(now_ns);
    skipped += timer.take(now_ns);
  }
  return times_ns;
}

}  // namespace

TEST_CASE("calls without delay occur once per period") {
  std::int64_t skipped = 0;
  CHECK(calls(Timer(period_ns, 0, 0), 0, 8000, skipped) ==
        std::vector<std::int64_t>{2000, 4000, 6000, 8000});
  CHECK(skipped == 0);
}

TEST_CASE("overdue calls are made at twice the rate until the nominal times are reached") {
  std::int64_t skipped = 0;
  CHECK(calls(Timer(period_ns, 10000, 0), 7500, 14000, skipped) ==
        std::vector<std::int64_t>{7500, 8500, 9500, 10500, 11500, 12500, 14000});
  CHECK(skipped == 0);
}

TEST_CASE("calls overdue by more than catch_up_ns are skipped and counted") {
  std::int64_t skipped = 0;
  CHECK(calls(Timer(period_ns, 0, 0), 9000, 12000, skipped) ==
        std::vector<std::int64_t>{9000, 10000, 12000});
  CHECK(skipped == 3);
}

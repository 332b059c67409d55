#include "launch/erp/run/renewal.hpp"

#include <catch2/catch.hpp>
#include <vector>

using launch::Renewal;
using Decision = launch::Renewal::Decision;

namespace {

constexpr std::int64_t ns_of_ms = 1'000'000;

/// A graph that starts in 1 s; frames stop from 10 s until `until_ms`, whatever is started again.
/// Returns the times in ms of the decisions.
std::vector<int> decisions(Decision wanted, int until_ms, int end_ms) {
  Renewal renewal;
  std::vector<int> times_ms;
  int started_ms = 0, stopped_since_ms = -1;
  for (int now_ms = 0; now_ms < end_ms; now_ms += 20) {
    const bool running = now_ms - started_ms >= 1000;
    const bool disturbed = now_ms >= 10'000 && now_ms < until_ms;
    if (!running || !disturbed) stopped_since_ms = -1;
    else if (stopped_since_ms < 0) stopped_since_ms = now_ms;
    const bool stays_stopped = running && stopped_since_ms >= 0;
    const auto decision = renewal.update(
        running, stays_stopped ? (now_ms - stopped_since_ms) * ns_of_ms : 0, now_ms * ns_of_ms);
    if (decision == Decision::renew) started_ms = now_ms, stopped_since_ms = -1;
    if (decision == wanted) times_ms.push_back(now_ms);
  }
  return times_ms;
}

}  // namespace

TEST_CASE("a graph without frames is started again within 2 s, and then until frames return") {
  const auto renewals = decisions(Decision::renew, 25'000, 60'000);
  REQUIRE(renewals.size() >= 4);
  CHECK(renewals.front() < 12'000);
  CHECK(renewals.back() < 25'000);
  for (std::size_t k = 1; k < renewals.size(); ++k) CHECK(renewals[k] - renewals[k - 1] < 4000);
  CHECK(decisions(Decision::give_up, 25'000, 60'000).empty());
}

TEST_CASE("a graph with frames, and one that starts slowly, are not started again") {
  CHECK(decisions(Decision::renew, 10'000, 60'000).empty());
  Renewal renewal;
  for (int now_ms = 0; now_ms < 60'000; now_ms += 20)
    CHECK(renewal.update(false, 0, now_ms * ns_of_ms) == Decision::none);
}

TEST_CASE("after 2 min without success it gives up") {
  CHECK_FALSE(decisions(Decision::give_up, 1'000'000, 200'000).empty());
  CHECK(decisions(Decision::give_up, 1'000'000, 200'000).front() > 120'000);
}

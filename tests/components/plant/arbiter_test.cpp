#include "components/plant/arbiter.hpp"

#include <catch2/catch.hpp>
#include <string>

#include "tests/components/plant/bench.hpp"

using bench::ms;
using erp::Mode;
using plant::Arbiter;

namespace {

constexpr std::int64_t stale_ns = 20 * ms, start_ns = 1000 * ms;

/// A table that is full with commands of one priority.
Arbiter full_table(int priority, std::int64_t now_ns) {
  Arbiter arbiter;
  for (std::size_t k = 0; k < Arbiter::max_controllers; ++k)
    REQUIRE(
        arbiter.update("weak_" + std::to_string(k), priority, Mode::force, 10, now_ns, stale_ns));
  arbiter.winner(now_ns, stale_ns);
  return arbiter;
}

}  // namespace

TEST_CASE("an off of priority 100 becomes the owner of a full table of priority −10") {
  Arbiter arbiter = full_table(-10, start_ns);
  REQUIRE(arbiter.update("emergency", 100, Mode::off, 0, start_ns, stale_ns));
  const auto* winner = arbiter.winner(start_ns, stale_ns);
  REQUIRE(winner);
  CHECK(std::string(winner->controller) == "emergency");
  CHECK(winner->mode == Mode::off);
}

TEST_CASE("in a full table a command of the same priority is refused unless it is an off") {
  Arbiter arbiter = full_table(0, start_ns);
  CHECK_FALSE(arbiter.update("ninth", 0, Mode::force, 10, start_ns, stale_ns));
  CHECK(arbiter.update("ninth", 0, Mode::off, 0, start_ns, stale_ns));
  CHECK(std::string(arbiter.winner(start_ns, stale_ns)->controller) ==
        "weak_0");  // keeps its place
}

TEST_CASE("a command of lower priority than all of a full table is refused") {
  Arbiter arbiter = full_table(0, start_ns);
  CHECK_FALSE(arbiter.update("ninth", -1, Mode::off, 0, start_ns, stale_ns));
}

TEST_CASE("a full table has room again once its commands are stale") {
  Arbiter arbiter = full_table(0, start_ns);
  CHECK(arbiter.update("ninth", -1, Mode::force, 10, start_ns + stale_ns + 1, stale_ns));
}

TEST_CASE("a command that was stale once is not followed when time runs backwards") {
  Arbiter arbiter;
  arbiter.update("a", 0, Mode::force, 40, start_ns, stale_ns);
  REQUIRE(arbiter.winner(start_ns, stale_ns));
  REQUIRE_FALSE(arbiter.winner(start_ns + stale_ns + 1, stale_ns));
  CHECK_FALSE(arbiter.winner(start_ns, stale_ns));
  CHECK(arbiter.owner().empty());
}

TEST_CASE("a command that was received in the future is stale") {
  Arbiter arbiter;
  arbiter.update("a", 0, Mode::force, 40, start_ns, stale_ns);
  CHECK_FALSE(arbiter.winner(start_ns - ms, stale_ns));
}

TEST_CASE("an emergency off stays the owner without its sender until a release of its priority") {
  Arbiter arbiter;
  constexpr auto top = erp::emergency_priority;
  arbiter.update("stop", top, Mode::off, 0, start_ns, stale_ns);
  const std::int64_t later_ns = start_ns + 1000 * stale_ns;
  arbiter.update("a", top, Mode::force, 40, later_ns, stale_ns);
  REQUIRE(arbiter.winner(later_ns, stale_ns));
  CHECK(arbiter.is_emergency_off());
  CHECK_FALSE(arbiter.update("stop", 0, Mode::force, 40, later_ns, stale_ns));
  arbiter.release("c", top - 1);
  arbiter.release("stop", 0);
  CHECK(arbiter.winner(later_ns, stale_ns));
  arbiter.release("b", top);
  const auto* winner = arbiter.winner(later_ns, stale_ns);
  REQUIRE(winner);
  CHECK(winner->mode == Mode::force);
}

TEST_CASE("an emergency off becomes the owner of an actuator of an owner with the same priority") {
  constexpr auto top = erp::emergency_priority;
  Arbiter arbiter = full_table(top, start_ns);
  REQUIRE(arbiter.update("stop", top, Mode::off, 0, start_ns, stale_ns));
  arbiter.winner(start_ns, stale_ns);
  CHECK(arbiter.is_emergency_off());
}

TEST_CASE("a controller that releases an actuator is no longer its owner") {
  Arbiter arbiter;
  arbiter.update("a", 0, Mode::force, 40, start_ns, stale_ns);
  REQUIRE(arbiter.winner(start_ns, stale_ns));
  arbiter.release("a", 0);
  CHECK_FALSE(arbiter.winner(start_ns, stale_ns));
  CHECK(arbiter.is_released());
}

#include <catch2/catch.hpp>
#include <numbers>
#include <vector>

#include "tests/components/plant/bench.hpp"

using namespace bench;

namespace {

/// A motor that winds as it is told, on a tendon that pulls at nothing.
struct Loose {
  Bench bench;
  double line_m = 0;

  /// Counts of the rig's kind: 2048 a motor turn, gear 128.
  std::int32_t encoder() const {
    return std::int32_t(-line_m / 0.0045 / (2 * std::numbers::pi) * 2048 * 128);
  }
  /// One period: the force law would wind at the motor's 37 mm/s.
  erp::EcuChannelCommand period(double reference_N, std::uint16_t tension) {
    bench.now_ns += 2 * ms;
    bench.says("a", 0, Mode::force, reference_N);
    bench.ecu_says(ECU_STATE_RUNNING, 0, encoder(), tension);
    const auto asked = bench.asks();
    if (asked.request == ECU_REQUEST_FORCE) line_m -= 0.037 * 0.002;
    if (asked.request == ECU_REQUEST_LENGTH)
      line_m = -0.0045 * asked.setpoint / (2048.0 * 128) * 2 * std::numbers::pi;
    return asked;
  }
  std::vector<plant::Notice> notices(const char* code) {
    auto all = bench.plant.take_notices();
    std::erase_if(all, [&](const auto& notice) { return notice.code != code; });
    return all;
  }
};

}  // namespace

TEST_CASE(
    "a tendon that snaps is let run for 16 ms, wound slowly for 30 mm, and then switched off") {
  Loose snapped;
  snapped.bench.run();
  int forced = 0;
  while (snapped.period(20, 0).request == ECU_REQUEST_FORCE) ++forced;
  CHECK(forced == 8);  // the ninth period is 16 ms after the first
  CHECK(snapped.notices("tendon_slack").size() == 1);
  int slow = 1;
  while (snapped.period(20, 0).request == ECU_REQUEST_LENGTH && slow < 5000) ++slow;
  CHECK(slow * 0.002 * 0.010 == Approx(0.030 - 10 * 0.037 * 0.002).epsilon(0.02));
  CHECK(snapped.notices("tendon_snapped").size() == 1);
  CHECK(-snapped.line_m == Approx(0.030).epsilon(0.02));
  for (int k = 0; k < 100; ++k) CHECK(snapped.period(20, 0).request == ECU_REQUEST_OFF);
  snapped.bench.ecu_says(ECU_STATE_IDLE);
  CHECK(snapped.bench.asks().request == ECU_REQUEST_OFF);
  snapped.bench.says("a", 0, Mode::off, 0);
  snapped.bench.asks();
  snapped.bench.says("a", 0, Mode::force, 20);
  CHECK(snapped.bench.asks().request == ECU_REQUEST_ARM);
}

TEST_CASE("slack that is taken up is forgotten, and the force law goes on") {
  Loose tendon;
  tendon.bench.run();
  for (int k = 0; k < 500; ++k) tendon.period(20, 0);
  CHECK(tendon.period(20, 0).request == ECU_REQUEST_LENGTH);
  CHECK(tendon.period(20, 819).request == ECU_REQUEST_FORCE);
  for (int k = 0; k < 7; ++k) CHECK(tendon.period(20, 0).request == ECU_REQUEST_FORCE);
  CHECK(tendon.period(20, 819).request == ECU_REQUEST_FORCE);
  CHECK(tendon.notices("tendon_slack").size() == 1);
}

TEST_CASE("after a rest slack is taken up from where the line is now, not from where it was") {
  Loose tendon;
  tendon.bench.run();
  for (int k = 0; k < 500; ++k) tendon.period(20, 0);
  tendon.bench.says("a", 0, Mode::off, 0);
  tendon.bench.asks();
  tendon.line_m = 0.010;  // let out by hand meanwhile
  tendon.bench.ecu_says(ECU_STATE_IDLE, 0, tendon.encoder(), 0);
  tendon.bench.asks();
  tendon.bench.run();
  int forced = 0;
  while (tendon.period(20, 0).request == ECU_REQUEST_FORCE) ++forced;
  CHECK(forced == 8);
  CHECK(tendon.line_m == Approx(0.010 - 8 * 0.037 * 0.002).margin(5e-5));
}

TEST_CASE("who asks for next to nothing may have a slack tendon") {
  Loose tendon;
  tendon.bench.run("a", Mode::force, 0.9);
  for (int k = 0; k < 500; ++k) CHECK(tendon.period(0.9, 0).request == ECU_REQUEST_FORCE);
}

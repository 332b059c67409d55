#include <catch2/catch.hpp>
#include <numbers>
#include <vector>

#include "tests/components/plant/bench.hpp"

using namespace bench;

namespace {

/// A motor that follows its requests exactly, with a tendon that is not attached to a load.
struct SlackTendon {
  Bench bench;
  double line_m = 0;

  /// Encoder counts: 2048 per motor turn, gear ratio 128.
  std::int32_t encoder() const {
    return std::int32_t(-line_m / 0.0045 / (2 * std::numbers::pi) * 2048 * 128);
  }
  /// One period; the force law winds at the motor's top speed of 37 mm/s.
  erp::EcuChannelCommand period(double reference_N, std::uint16_t tension) {
    bench.now_ns += 2 * ms;
    bench.command("a", 0, Mode::force, reference_N);
    bench.ecu_reports(ECU_STATE_RUNNING, 0, encoder(), tension);
    const auto request = bench.request();
    if (request.request == ECU_REQUEST_FORCE) line_m -= 0.037 * 0.002;
    if (request.request == ECU_REQUEST_LENGTH)
      line_m = -0.0045 * request.setpoint / (2048.0 * 128) * 2 * std::numbers::pi;
    return request;
  }
  std::vector<plant::Notice> notices(const char* code) {
    auto all = bench.plant.take_notices();
    std::erase_if(all, [&](const auto& notice) { return notice.code != code; });
    return all;
  }
};

}  // namespace

TEST_CASE(
    "after a tendon snaps the force law runs for 16 ms, 30 mm are wound slowly, then the ECU is "
    "off") {
  SlackTendon snapped;
  snapped.bench.run();
  int force_periods = 0;
  while (snapped.period(20, 0).request == ECU_REQUEST_FORCE) ++force_periods;
  CHECK(force_periods == 8);  // the ninth period is 16 ms after the first
  CHECK(snapped.notices("tendon_slack").size() == 1);
  int winding_periods = 1;
  while (snapped.period(20, 0).request == ECU_REQUEST_LENGTH && winding_periods < 5000)
    ++winding_periods;
  CHECK(winding_periods * 0.002 * 0.010 == Approx(0.030 - 10 * 0.037 * 0.002).epsilon(0.02));
  CHECK(snapped.notices("tendon_snapped").size() == 1);
  CHECK(-snapped.line_m == Approx(0.030).epsilon(0.02));
  for (int k = 0; k < 100; ++k) CHECK(snapped.period(20, 0).request == ECU_REQUEST_OFF);
  snapped.bench.ecu_reports(ECU_STATE_IDLE);
  CHECK(snapped.bench.request().request == ECU_REQUEST_OFF);
  snapped.bench.command("a", 0, Mode::off, 0);
  snapped.bench.request();
  snapped.bench.command("a", 0, Mode::force, 20);
  CHECK(snapped.bench.request().request == ECU_REQUEST_ARM);
}

TEST_CASE("the force law continues after slack has been taken up") {
  SlackTendon tendon;
  tendon.bench.run();
  for (int k = 0; k < 500; ++k) tendon.period(20, 0);
  CHECK(tendon.period(20, 0).request == ECU_REQUEST_LENGTH);
  CHECK(tendon.period(20, 819).request == ECU_REQUEST_FORCE);
  for (int k = 0; k < 7; ++k) CHECK(tendon.period(20, 0).request == ECU_REQUEST_FORCE);
  CHECK(tendon.period(20, 819).request == ECU_REQUEST_FORCE);
  CHECK(tendon.notices("tendon_slack").size() == 1);
}

TEST_CASE("after mode off, slack is taken up from the new line length") {
  SlackTendon tendon;
  tendon.bench.run();
  for (int k = 0; k < 500; ++k) tendon.period(20, 0);
  tendon.bench.command("a", 0, Mode::off, 0);
  tendon.bench.request();
  tendon.line_m = 0.010;  // unwound by hand while off
  tendon.bench.ecu_reports(ECU_STATE_IDLE, 0, tendon.encoder(), 0);
  tendon.bench.request();
  tendon.bench.run();
  int force_periods = 0;
  while (tendon.period(20, 0).request == ECU_REQUEST_FORCE) ++force_periods;
  CHECK(force_periods == 8);
  CHECK(tendon.line_m == Approx(0.010 - 8 * 0.037 * 0.002).margin(5e-5));
}

TEST_CASE("a force reference of 0.9 N, below twice the slack threshold, is not treated as slack") {
  SlackTendon tendon;
  tendon.bench.run("a", Mode::force, 0.9);
  for (int k = 0; k < 500; ++k) CHECK(tendon.period(0.9, 0).request == ECU_REQUEST_FORCE);
}

#include <catch2/catch.hpp>
#include <limits>

#include "tests/components/plant/bench.hpp"

using namespace bench;

TEST_CASE("ECU counts are converted to SI and references to counts") {
  Bench bench;
  bench.run("a", Mode::force, 20);
  CHECK(bench.request().request == ECU_REQUEST_FORCE);
  CHECK(bench.request().setpoint == 20000);
  erp::EcuFrame frame;
  erp::EcuChannelSample channel{};
  channel.fresh = true, channel.state = ECU_STATE_RUNNING, channel.encoder_counts = 2048 * 128;
  channel.zero_known = true;
  channel.tension_counts = 4095, channel.duty_counts = -1023, channel.current_counts = 1024;
  erp::append(frame.channels, channel);
  const auto& sample = bench.plant.sense(frame, bench.now_ns).actuators._buffer[0];
  CHECK(sample.shaft_rad == Approx(2 * 3.14159265358979));
  CHECK(sample.line_m == Approx(-0.0045 * 2 * 3.14159265358979));
  CHECK(sample.tension_N == Approx(200.0));
  CHECK(sample.voltage_V == Approx(-12.0));
  CHECK(sample.current_A == Approx(4.0));
}

TEST_CASE("the controller of higher priority is the owner until its command is stale") {
  Bench bench;
  bench.run("low", Mode::force, 10);
  bench.command("high", 5, Mode::force, 30);
  CHECK(bench.request().setpoint == 30000);
  CHECK(std::string(bench.owner().owner) == "high");
  bench.now_ns += 15 * ms;
  bench.command("low", 0, Mode::force, 10);
  CHECK(bench.request().setpoint == 30000);
  CHECK(bench.owner().refused == 1);
  bench.now_ns += 6 * ms;
  CHECK(bench.request().setpoint == 10000);
  CHECK(std::string(bench.owner().owner) == "low");
}

TEST_CASE("among equal priorities the current owner remains owner") {
  Bench bench;
  bench.run("first", Mode::force, 10);
  bench.command("second", 0, Mode::force, 30);
  CHECK(bench.request().setpoint == 10000);
}

TEST_CASE("a stale command leads to the actuator's safe action") {
  const auto stale = [](erp::SafeAction safe) {
    Bench bench(safe);
    bench.run("a", Mode::force, 20);
    bench.ecu_reports(ECU_STATE_RUNNING, 0, 5000);
    bench.now_ns += 21 * ms;
    const auto request = bench.request();
    CHECK(bench.owner().safe_action == static_cast<std::uint8_t>(safe));
    CHECK(std::string(bench.owner().owner).empty());
    return request;
  };
  const auto hold = stale(erp::SafeAction::hold);
  CHECK(hold.request == ECU_REQUEST_LENGTH);
  CHECK(hold.setpoint == 5000);
  const auto relax = stale(erp::SafeAction::relax);
  CHECK(relax.request == ECU_REQUEST_FORCE);
  CHECK(relax.setpoint == 2000);
  const auto damp = stale(erp::SafeAction::damp);
  CHECK(damp.request == ECU_REQUEST_VOLTAGE);
  CHECK(damp.setpoint == 0);
}

TEST_CASE("hold keeps the line length at which the command became stale") {
  Bench bench(erp::SafeAction::hold);
  bench.run("a", Mode::force, 20);
  bench.ecu_reports(ECU_STATE_RUNNING, 0, 5000);
  bench.now_ns += 21 * ms;
  bench.request();
  bench.ecu_reports(ECU_STATE_RUNNING, 0, 4000);
  CHECK(bench.request().setpoint == 5000);
}

TEST_CASE("an idle ECU is armed only when a controller sends a command") {
  Bench bench;
  bench.ecu_reports(ECU_STATE_IDLE);
  CHECK(bench.request().request == ECU_REQUEST_OFF);
  bench.command("a", 0, Mode::force, 20);
  CHECK(bench.request().request == ECU_REQUEST_ARM);
}

TEST_CASE("a command received before arming does not move the actuator") {
  Bench bench;
  bench.ecu_reports(ECU_STATE_IDLE);
  bench.command("a", 0, Mode::force, 20);
  bench.now_ns += 2 * ms;
  bench.ecu_reports(ECU_STATE_ARMED);
  CHECK(bench.request().request == ECU_REQUEST_ARM);
  bench.now_ns += 2 * ms;
  bench.command("a", 0, Mode::force, 20);
  CHECK(bench.request().request == ECU_REQUEST_FORCE);
}

TEST_CASE("after arming a length reference is approached from the measured length") {
  Bench bench;
  bench.ecu_reports(ECU_STATE_IDLE, 0, 10000);
  bench.request();
  bench.ecu_reports(ECU_STATE_ARMED, 0, 10000);
  bench.now_ns += 2 * ms;
  bench.command("a", 0, Mode::length, -0.05);
  const auto first = bench.request().setpoint;
  CHECK(first > 10000);
  CHECK(first < 10700);  // half the top speed of 37 mm/s for 2 ms is 0.037 mm, 340 counts
}

TEST_CASE("a command timeout is cleared automatically, other faults only by mode off") {
  Bench bench;
  bench.ecu_reports(ECU_STATE_FAULT, ECU_FAULT_COMMAND_TIMEOUT);
  CHECK(bench.request().request == ECU_REQUEST_CLEAR);
  CHECK(bench.request().setpoint == ECU_FAULT_COMMAND_TIMEOUT);
  bench.ecu_reports(ECU_STATE_FAULT, ECU_FAULT_OVER_CURRENT);
  bench.command("a", 0, Mode::force, 20);
  CHECK(bench.request().request == ECU_REQUEST_OFF);
  bench.command("a", 0, Mode::off, 0);
  CHECK(bench.request().request == ECU_REQUEST_CLEAR);
}

TEST_CASE("a NaN reference is refused and the previous command becomes stale") {
  Bench bench;
  bench.run("a", Mode::force, 20);
  bench.now_ns += 15 * ms;
  bench.command("a", 0, Mode::force, std::numeric_limits<double>::quiet_NaN());
  CHECK(bench.request().setpoint == 20000);
  CHECK(bench.owner().refused == 1);
  CHECK(std::string(bench.owner().reason) == "reference is not a number");
  bench.now_ns += 6 * ms;
  CHECK(bench.request().setpoint == 2000);
}

TEST_CASE("references beyond the limit are limited, counted and reported once") {
  Bench bench;
  bench.run("a", Mode::force, 20);
  bench.plant.take_notices();
  bench.command("a", 0, Mode::force, 200);
  CHECK(bench.request().setpoint == 150000);
  bench.command("a", 0, Mode::force, 200);
  bench.request();
  CHECK(bench.owner().limited == 2);
  CHECK(bench.plant.take_notices().size() == 1);
  bench.command("a", 0, Mode::force, -3);
  CHECK(bench.owner().refused == 1);
}

TEST_CASE("a device silent for 51 ms is reported once and every ECU is commanded off") {
  Bench bench;
  bench.run();
  bench.now_ns += 51 * ms;
  CHECK(bench.plant.check_device(bench.now_ns));
  CHECK(bench.request().request == ECU_REQUEST_OFF);
  CHECK_FALSE(bench.plant.check_device(bench.now_ns));
}

TEST_CASE("a command for an unknown actuator is reported with its name") {
  Bench bench;
  erp::ActuatorCommand command;
  erp::assign(command.controller, "a");
  erp::ActuatorReference r{};
  erp::assign(r.name, "flexr");
  erp::append(command.actuators, r);
  bench.plant.receive(command, bench.now_ns);
  const auto notices = bench.plant.take_notices();
  REQUIRE(notices.size() == 1);
  CHECK(notices[0].text.find("flexr") != std::string::npos);
}

plant::Notice stale(const std::string& actuator) {
  return {erp::Severity::warning, actuator, "stale_command", "a became stale"};
}

TEST_CASE("equal notices of all actuators become one notice") {
  const auto merged =
      plant::merge_similar({stale("flexor"), stale("extensor"), stale("biceps")}, 3);
  REQUIRE(merged.size() == 1);
  CHECK(merged[0].subject == "all 3 actuators");
  CHECK(merged[0].text == "a became stale");
}

TEST_CASE(
    "equal notices of four of 54 actuators become one that names three; others are unchanged") {
  const plant::Notice fault{erp::Severity::fault, "", "device_lost", "no frame"};
  const auto merged =
      plant::merge_similar({stale("a"), fault, stale("b"), stale("c"), stale("d")}, 54);
  REQUIRE(merged.size() == 2);
  CHECK(merged[0].subject == "4 actuators");
  CHECK(merged[0].text == "a became stale (a, b, c …)");
  CHECK(merged[1].code == "device_lost");
  CHECK(plant::merge_similar({stale("a"), stale("b")}, 54).size() == 2);
}

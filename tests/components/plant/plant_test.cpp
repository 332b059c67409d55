#include <catch2/catch.hpp>
#include <limits>

#include "tests/components/plant/bench.hpp"

using namespace bench;

TEST_CASE("counts become SI and SI becomes counts") {
  Bench bench;
  bench.run("a", Mode::force, 20);
  CHECK(bench.asks().request == ECU_REQUEST_FORCE);
  CHECK(bench.asks().setpoint == 20000);
  erp::EcuFrame frame;
  erp::EcuChannelSample channel{};
  channel.fresh = true, channel.state = ECU_STATE_RUNNING, channel.encoder_counts = 2048 * 128;
  channel.tension_counts = 4095, channel.duty_counts = -1023, channel.current_counts = 1024;
  erp::append(frame.channels, channel);
  const auto& sample = bench.plant.sense(frame, bench.now_ns).actuators._buffer[0];
  CHECK(sample.shaft_rad == Approx(2 * 3.14159265358979));
  CHECK(sample.line_m == Approx(-0.0045 * 2 * 3.14159265358979));
  CHECK(sample.tension_N == Approx(200.0));
  CHECK(sample.voltage_V == Approx(-12.0));
  CHECK(sample.current_A == Approx(4.0));
}

TEST_CASE("the higher priority drives, and the other takes over when it goes stale") {
  Bench bench;
  bench.run("low", Mode::force, 10);
  bench.says("high", 5, Mode::force, 30);
  CHECK(bench.asks().setpoint == 30000);
  CHECK(std::string(bench.owner().owner) == "high");
  bench.now_ns += 15 * ms;
  bench.says("low", 0, Mode::force, 10);
  CHECK(bench.asks().setpoint == 30000);
  CHECK(bench.owner().refused == 1);
  bench.now_ns += 6 * ms;
  CHECK(bench.asks().setpoint == 10000);
  CHECK(std::string(bench.owner().owner) == "low");
}

TEST_CASE("between equals the one that drives keeps driving") {
  Bench bench;
  bench.run("first", Mode::force, 10);
  bench.says("second", 0, Mode::force, 30);
  CHECK(bench.asks().setpoint == 10000);
}

TEST_CASE("a stale command ends in the actuator's safe action") {
  const auto stale = [](erp::SafeAction safe) {
    Bench bench(safe);
    bench.run("a", Mode::force, 20);
    bench.ecu_says(ECU_STATE_RUNNING, 0, 5000);
    bench.now_ns += 21 * ms;
    const auto asked = bench.asks();
    CHECK(bench.owner().safe_action == static_cast<std::uint8_t>(safe));
    CHECK(std::string(bench.owner().owner).empty());
    return asked;
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

TEST_CASE("a held line stays where it was when the command went stale") {
  Bench bench(erp::SafeAction::hold);
  bench.run("a", Mode::force, 20);
  bench.ecu_says(ECU_STATE_RUNNING, 0, 5000);
  bench.now_ns += 21 * ms;
  bench.asks();
  bench.ecu_says(ECU_STATE_RUNNING, 0, 4000);
  CHECK(bench.asks().setpoint == 5000);
}

TEST_CASE("an ECU is armed only when somebody wants to drive") {
  Bench bench;
  bench.ecu_says(ECU_STATE_IDLE);
  CHECK(bench.asks().request == ECU_REQUEST_OFF);
  bench.says("a", 0, Mode::force, 20);
  CHECK(bench.asks().request == ECU_REQUEST_ARM);
}

TEST_CASE("a command from before arming never moves the actuator") {
  Bench bench;
  bench.ecu_says(ECU_STATE_IDLE);
  bench.says("a", 0, Mode::force, 20);
  bench.now_ns += 2 * ms;
  bench.ecu_says(ECU_STATE_ARMED);
  CHECK(bench.asks().request == ECU_REQUEST_ARM);
  bench.now_ns += 2 * ms;
  bench.says("a", 0, Mode::force, 20);
  CHECK(bench.asks().request == ECU_REQUEST_FORCE);
}

TEST_CASE("after arming a length reference is approached from the measured length") {
  Bench bench;
  bench.ecu_says(ECU_STATE_IDLE, 0, 10000);
  bench.asks();
  bench.ecu_says(ECU_STATE_ARMED, 0, 10000);
  bench.now_ns += 2 * ms;
  bench.says("a", 0, Mode::length, -0.05);
  const auto first = bench.asks().setpoint;
  CHECK(first > 10000);
  CHECK(first < 10700);  // half the top speed of 37 mm/s for 2 ms is 0.037 mm, 340 counts
}

TEST_CASE("silence is forgiven by speaking again, other faults only by saying off") {
  Bench bench;
  bench.ecu_says(ECU_STATE_FAULT, ECU_FAULT_COMMAND_TIMEOUT);
  CHECK(bench.asks().request == ECU_REQUEST_CLEAR);
  CHECK(bench.asks().setpoint == ECU_FAULT_COMMAND_TIMEOUT);
  bench.ecu_says(ECU_STATE_FAULT, ECU_FAULT_OVER_CURRENT);
  bench.says("a", 0, Mode::force, 20);
  CHECK(bench.asks().request == ECU_REQUEST_OFF);
  bench.says("a", 0, Mode::off, 0);
  CHECK(bench.asks().request == ECU_REQUEST_CLEAR);
}

TEST_CASE("a reference that is not a number is refused and the old one goes stale") {
  Bench bench;
  bench.run("a", Mode::force, 20);
  bench.now_ns += 15 * ms;
  bench.says("a", 0, Mode::force, std::numeric_limits<double>::quiet_NaN());
  CHECK(bench.asks().setpoint == 20000);
  CHECK(bench.owner().refused == 1);
  CHECK(std::string(bench.owner().reason) == "reference is not a number");
  bench.now_ns += 6 * ms;
  CHECK(bench.asks().setpoint == 2000);
}

TEST_CASE("a reference beyond the limit is limited, counted and said once") {
  Bench bench;
  bench.run("a", Mode::force, 20);
  bench.plant.take_notices();
  bench.says("a", 0, Mode::force, 200);
  CHECK(bench.asks().setpoint == 150000);
  bench.says("a", 0, Mode::force, 200);
  bench.asks();
  CHECK(bench.owner().limited == 2);
  CHECK(bench.plant.take_notices().size() == 1);
  bench.says("a", 0, Mode::force, -3);
  CHECK(bench.owner().refused == 1);
}

TEST_CASE("a silent device leaves nothing believed") {
  Bench bench;
  bench.run();
  bench.now_ns += 51 * ms;
  CHECK(bench.plant.check_device(bench.now_ns));
  CHECK(bench.asks().request == ECU_REQUEST_OFF);
  CHECK_FALSE(bench.plant.check_device(bench.now_ns));
}

TEST_CASE("an actuator this robot does not have is said") {
  Bench bench;
  erp::ActuatorCommand command;
  erp::assign(command.controller, "a");
  erp::ActuatorReference r{};
  erp::assign(r.name, "flexr");
  erp::append(command.actuators, r);
  bench.plant.accept(command, bench.now_ns);
  const auto notices = bench.plant.take_notices();
  REQUIRE(notices.size() == 1);
  CHECK(notices[0].text.find("flexr") != std::string::npos);
}

plant::Notice stale(const std::string& actuator) {
  return {erp::Severity::warning, actuator, "stale_command", "a went stale"};
}

TEST_CASE("what befalls all actuators at once is said once") {
  const auto said = plant::together({stale("flexor"), stale("extensor"), stale("biceps")}, 3);
  REQUIRE(said.size() == 1);
  CHECK(said[0].subject == "all 3 actuators");
  CHECK(said[0].text == "a went stale");
}

TEST_CASE("what befalls some of the actuators names the first, and the rest stays as it was") {
  const plant::Notice fault{erp::Severity::fault, "", "device_lost", "no frame"};
  const auto said = plant::together({stale("a"), fault, stale("b"), stale("c"), stale("d")}, 54);
  REQUIRE(said.size() == 2);
  CHECK(said[0].subject == "4 actuators");
  CHECK(said[0].text == "a went stale (a, b, c …)");
  CHECK(said[1].code == "device_lost");
  CHECK(plant::together({stale("a"), stale("b")}, 54).size() == 2);
}

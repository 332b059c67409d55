#include "components/plant/plant.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <vector>

using erp::Mode;
using plant::Plant;

namespace {

constexpr std::int64_t ms = 1'000'000;

erp::Robot one_muscle(erp::SafeAction safe = erp::SafeAction::relax) {
  erp::Robot robot;
  robot.name = "one";
  erp::MotorType motor;
  motor.name = "m";
  motor.resistance_ohm = 0.5, motor.inductance_H = 5e-5, motor.back_emf_V_s_per_rad = 0.0115;
  motor.torque_Nm_per_A = 0.0115, motor.gear_ratio = 128, motor.gear_efficiency = 0.59;
  motor.rotor_inertia_kg_m2 = 14.5e-7, motor.supply_V = 12, motor.current_limit_A = 4;
  robot.motor_types.push_back(motor);
  erp::SensorType sensors;
  sensors.name = "s";
  robot.sensor_types.push_back(sensors);
  erp::Actuator actuator;
  actuator.name = "flexor", actuator.motor = "m", actuator.sensors = "s";
  actuator.max_tension_N = 150, actuator.safe_action = safe, actuator.spindle.radius_m = 0.0045;
  robot.actuators.push_back(actuator);
  return robot;
}

/// A plant with one actuator, and a hand to play controllers and the ECU.
struct Bench {
  Plant plant;
  std::int64_t now_ns = 1000 * ms;
  std::uint64_t sequence = 0;
  explicit Bench(erp::SafeAction safe = erp::SafeAction::relax) : plant({}, one_muscle(safe)) {}

  void ecu_says(ecu_state state, std::uint8_t fault = 0, std::int32_t encoder = 0,
                std::uint16_t tension = 819) {
    erp::EcuFrame frame;
    frame.sequence = sequence++;
    frame.stamp_ns = now_ns;
    erp::EcuChannelSample channel{};
    channel.fresh = true, channel.state = static_cast<std::uint8_t>(state), channel.fault = fault;
    channel.encoder_counts = encoder, channel.tension_counts = tension;
    erp::append(frame.channels, channel);
    plant.sense(frame, now_ns);
  }
  void says(const char* controller, int priority, Mode mode, double reference) {
    erp::ActuatorCommand command;
    erp::assign(command.controller, controller);
    command.priority = priority;
    erp::ActuatorReference r{};
    erp::assign(r.name, "flexor");
    r.mode = static_cast<std::uint8_t>(mode), r.reference = reference;
    erp::append(command.actuators, r);
    plant.accept(command, now_ns);
  }
  erp::EcuChannelCommand asks() { return plant.command(now_ns).channels._buffer[0]; }
  erp::ActuatorOwnerSample owner() { return plant.owners().actuators._buffer[0]; }
  void run(const char* controller = "a", Mode mode = Mode::force, double reference = 20) {
    ecu_says(ECU_STATE_ARMED);
    now_ns += 2 * ms;
    says(controller, 0, mode, reference);
    ecu_says(ECU_STATE_RUNNING);
    asks();
  }
};

}  // namespace

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

namespace {

/// A motor that winds as it is told, on a tendon that pulls at nothing.
struct Loose {
  Bench bench;
  double line_m = 0, wound_s = 0;

  /// Counts of the rig's kind: 2048 a motor turn, gear 128.
  std::int32_t encoder() const { return std::int32_t(-line_m / 0.0045 / (2 * M_PI) * 2048 * 128); }
  /// One period: the force law would wind at the motor's 37 mm/s.
  erp::EcuChannelCommand period(double reference_N, std::uint16_t tension) {
    bench.now_ns += 2 * ms;
    bench.says("a", 0, Mode::force, reference_N);
    bench.ecu_says(ECU_STATE_RUNNING, 0, encoder(), tension);
    const auto asked = bench.asks();
    if (asked.request == ECU_REQUEST_FORCE) line_m -= 0.037 * 0.002;
    if (asked.request == ECU_REQUEST_LENGTH)
      line_m = -0.0045 * asked.setpoint / (2048.0 * 128) * 2 * M_PI;
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
    "a tendon that snaps is let run for 20 ms, wound slowly for 30 mm, and then switched off") {
  Loose snapped;
  snapped.bench.run();
  int forced = 0;
  while (snapped.period(20, 0).request == ECU_REQUEST_FORCE) ++forced;
  CHECK(forced == 10);  // the eleventh period is 20 ms after the first
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
  for (int k = 0; k < 9; ++k) CHECK(tendon.period(20, 0).request == ECU_REQUEST_FORCE);
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
  CHECK(forced == 10);
  CHECK(tendon.line_m == Approx(0.010 - 10 * 0.037 * 0.002).margin(5e-5));
}

TEST_CASE("who asks for next to nothing may have a slack tendon") {
  Loose tendon;
  tendon.bench.run("a", Mode::force, 0.9);
  for (int k = 0; k < 500; ++k) CHECK(tendon.period(0.9, 0).request == ECU_REQUEST_FORCE);
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

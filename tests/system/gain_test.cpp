// The gains of a running ECU are changed over the bus while it holds a position.
#include <catch2/catch.hpp>
#include <optional>

#include "components/node/bus.hpp"
#include "components/node/clock.hpp"
#include "firmware/core/ecu.h"
#include "interfaces/robot/robot.hpp"
#include "tests/system/background.hpp"

using namespace tests;

namespace {

// Length reference of both tendons: co-contraction by about 30 PWM steps.
constexpr double wound_m = -0.02;

/// A test controller: commands both lines shorter than their current length and returns the samples
/// of the flexor.
class TestController {
 public:
  TestController() : robot_(erp::read_robot(ERP_SOURCE_DIR "/configs/hinge_rig/robot.xml")) {}

  /// Sends a command for every frame for `seconds`. Returns the last sample of the flexor.
  erp::ActuatorSample run_for(double seconds) {
    erp::ActuatorSample flexor{};
    const auto end_ns = node::monotonic_ns() + static_cast<std::int64_t>(1e9 * seconds);
    while (node::monotonic_ns() < end_ns) {
      frames_.take([&](const erp::SensorFrame& frame) {
        send_command(frame);
        flexor = frame.actuators._buffer[0];
      });
      std::this_thread::sleep_for(1ms);
    }
    REQUIRE(std::string(flexor.name) == "flexor");
    return flexor;
  }
  void set_gain(const std::string& name, const std::string& parameter, double value) {
    erp::GainCommand command;
    erp::assign(command.robot, robot_.name);
    erp::assign(command.controller, "hand");
    erp::GainValue gain{};
    erp::assign(gain.name, name);
    erp::assign(gain.parameter, parameter);
    gain.value = value;
    erp::append(command.gains, gain);
    gains_.write(command);
  }
  /// The proportional gain kp in V/rad: measured voltage over position error of the shaft.
  double measured_gain_V_per_rad(const erp::ActuatorSample& s) const {
    return s.voltage_V / position_error_rad(s);
  }
  /// Expected voltage for this gain, with a margin of one PWM step.
  Approx with_gain(double V_per_rad, const erp::ActuatorSample& s) const {
    const double step_V = robot_.motor_of(robot_.actuators[0]).supply_V / ECU_DUTY_MAX;
    return Approx(V_per_rad * position_error_rad(s)).margin(step_V);
  }

 private:
  double position_error_rad(const erp::ActuatorSample& s) const {
    return -wound_m / robot_.actuators[0].spindle.radius_m - s.shaft_rad;
  }
  void send_command(const erp::SensorFrame& frame) {
    erp::ActuatorCommand command;
    erp::assign(command.robot, robot_.name);
    erp::assign(command.controller, "hand");
    command.stamp_ns = node::wall_ns();
    command.answers = frame.sequence;
    for (const auto& actuator : robot_.actuators) {
      erp::ActuatorReference reference{};
      erp::assign(reference.name, actuator.name);
      reference.mode = static_cast<std::uint8_t>(erp::Mode::length);
      reference.reference = wound_m;
      erp::append(command.actuators, reference);
    }
    commands_.write(command);
  }

  erp::Robot robot_;
  node::Entity participant_ = node::join("hand");
  node::Wake wake_;
  node::Reader<erp::SensorFrame> frames_{participant_, wake_};
  node::Writer<erp::ActuatorCommand> commands_{participant_};
  node::Writer<erp::GainCommand> gains_{participant_};
};

}  // namespace

TEST_CASE(
    "halving a gain of a running ECU halves its voltage; unknown gains, gains that the ECU refuses "
    "and"
    " limits above robot.xml are reported") {
  Folder folder;
  Background graph({"launch", "launch/idle.xml", "--out", folder / "run"}, folder / "run.txt");
  REQUIRE(graph.wait_for_output("all components are active"));
  TestController controller;
  const auto before = controller.run_for(2);
  REQUIRE(int{before.ecu_state} == static_cast<int>(erp::EcuState::running));
  const double gain = controller.measured_gain_V_per_rad(before);
  REQUIRE(gain > 0);
  controller.set_gain("flexor", "length_gain_V_per_rad", gain / 2);
  const auto after = controller.run_for(2);
  CHECK(int{after.ecu_state} == static_cast<int>(erp::EcuState::running));
  CHECK(after.voltage_V == controller.with_gain(gain / 2, after));
  controller.set_gain("flexor", "charm", 1);
  controller.set_gain("flexor", "charm", 2);
  const auto last = controller.run_for(0.5);
  CHECK(last.voltage_V == controller.with_gain(gain / 2, last));
  controller.set_gain("flexor", "length_gain_V_per_rad", -1);
  controller.set_gain("flexor", "tension_trip_N", 500);
  CHECK(graph.wait_for_output("its ECU refused length_gain_V_per_rad = -1"));
  CHECK(graph.wait_for_output("tension_trip_N must be above 0 and at most robot.xml's"));
  const auto unchanged = controller.run_for(0.5);
  CHECK(unchanged.voltage_V == controller.with_gain(gain / 2, unchanged));
  CHECK(graph.stop() == 0);
  const auto output = graph.output();
  CHECK(output.find("its ECU accepted length_gain_V_per_rad") != output.npos);
  const auto first = output.find("there is no gain charm");
  CHECK(first != output.npos);
  CHECK(output.find("there is no gain charm", first + 1) == output.npos);  // reported once
}

// The gains of a running ECU are changed from a higher layer, over the bus, while it holds.
#include <catch2/catch.hpp>
#include <optional>

#include "components/node/bus.hpp"
#include "components/node/clock.hpp"
#include "firmware/core/ecu.h"
#include "interfaces/robot/robot.hpp"
#include "tests/system/background.hpp"

using namespace tests;

namespace {

constexpr double wound_m = -0.02;  // both tendons: they pull against each other, by 30 steps of PWM

/// A controller by hand: holds both lines shorter than they are, and looks at the flexor.
class Hand {
 public:
  Hand() : robot_(erp::read_robot(ERP_SOURCE_DIR "/configs/hinge_rig/robot.xml")) {}

  /// Answers every frame for `seconds`. Returns the flexor's last sample.
  erp::ActuatorSample hold(double seconds) {
    erp::ActuatorSample flexor{};
    const auto end_ns = node::monotonic_ns() + static_cast<std::int64_t>(1e9 * seconds);
    while (node::monotonic_ns() < end_ns) {
      frames_.take([&](const erp::SensorFrame& frame) {
        answer(frame);
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
  /// V per rad of what is missing at the shaft: the law's kp, as it shows.
  double gain_of(const erp::ActuatorSample& s) const { return s.voltage_V / missing_rad(s); }
  /// The voltage that the law gives with this gain; the ECU sends whole steps of PWM.
  Approx with_gain(double V_per_rad, const erp::ActuatorSample& s) const {
    const double step_V = robot_.motor_of(robot_.actuators[0]).supply_V / ECU_DUTY_MAX;
    return Approx(V_per_rad * missing_rad(s)).margin(step_V);
  }

 private:
  double missing_rad(const erp::ActuatorSample& s) const {
    return -wound_m / robot_.actuators[0].spindle.radius_m - s.shaft_rad;
  }
  void answer(const erp::SensorFrame& frame) {
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

TEST_CASE("a gain of a running ECU is halved from outside, a mistaken one is refused") {
  Folder folder;
  Background graph({"launch", "launch/idle.xml", "--out", folder / "run"}, folder / "run.txt");
  REQUIRE(graph.says("all components are active"));
  Hand hand;
  const auto before = hand.hold(2);
  REQUIRE(int{before.ecu_state} == static_cast<int>(erp::EcuState::running));
  const double gain = hand.gain_of(before);
  REQUIRE(gain > 0);
  hand.set_gain("flexor", "length_gain_V_per_rad", gain / 2);
  const auto after = hand.hold(2);
  CHECK(int{after.ecu_state} == static_cast<int>(erp::EcuState::running));
  CHECK(after.voltage_V == hand.with_gain(gain / 2, after));
  hand.set_gain("flexor", "charm", 1);
  hand.set_gain("flexor", "charm", 2);
  const auto last = hand.hold(0.5);
  CHECK(last.voltage_V == hand.with_gain(gain / 2, last));
  CHECK(graph.stop() == 0);
  const auto said = graph.output();
  const auto first = said.find("there is no gain charm of flexor");
  CHECK(first != said.npos);
  CHECK(said.find("there is no gain charm", first + 1) == said.npos);  // once
}

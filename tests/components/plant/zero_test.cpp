// The zeros of the encoders: lost by resets, set by potentiometers, by the starting pose and by
// controllers; length references without a zero.
#include <catch2/catch.hpp>
#include <cmath>

#include "interfaces/emergency.hpp"
#include "tests/components/plant/bench.hpp"

using namespace bench;

namespace {

constexpr double wound_m = 0.03;

/// A plant with one actuator and the ECU's counter; the ECU accepts every zero that is sent.
struct Robot {
  Plant plant;
  erp::Robot robot;
  double shaft_rad = 0;  ///< true angle; 0 in the starting pose
  double start_rad = 0;  ///< true angle at the last reset
  std::int32_t zero_counts = 0;
  bool zero_known = false;
  ecu_state state = ECU_STATE_BOOT;
  double joint_rad = 0;
  std::int64_t now_ns = 1000 * ms;
  std::uint64_t sequence = 0;
  int zeros_sent = 0, made_unknown = 0;
  std::vector<plant::Notice> notices;

  explicit Robot(const erp::Robot& r) : plant({}, r), robot(r) {}

  double rad_per_count() const { return 2 * M_PI / (2048 * 128); }
  std::int32_t counts() const {
    return static_cast<std::int32_t>(std::lround((shaft_rad - start_rad) / rad_per_count()));
  }
  void reset() {
    start_rad = shaft_rad, zero_counts = 0, zero_known = false, state = ECU_STATE_BOOT;
  }
  /// One period of 2 ms; returns the request to the ECU.
  erp::EcuChannelCommand tick() {
    now_ns += 2 * ms;
    ++sequence;
    plant.sense(frame(), now_ns);
    for (const auto& value : erp::samples(plant.gains(now_ns, false).values)) receive(value);
    const auto request = plant.command(now_ns).channels._buffer[0];
    for (auto& notice : plant.take_notices()) notices.push_back(notice);
    return request;
  }
  void ticks(int count) {
    for (int i = 0; i < count; ++i) tick();
  }
  void receive(const erp::EcuParameterValue& value) {
    if (value.index != ECU_ZERO) return;
    ++zeros_sent;
    zero_known = std::isfinite(value.value);
    if (!zero_known) ++made_unknown;
    zero_counts = zero_known ? static_cast<std::int32_t>(value.value) : 0;
  }
  void command(Mode mode, double reference) { command(static_cast<std::uint8_t>(mode), reference); }
  void command(std::uint8_t mode, double reference) {
    now_ns += ms;  // commands arrive between frames
    erp::ActuatorCommand command;
    erp::assign(command.controller, "a");
    erp::ActuatorReference r{};
    erp::assign(r.name, "flexor");
    r.mode = mode, r.reference = reference;
    erp::append(command.actuators, r);
    plant.receive(command, now_ns);
  }
  erp::ActuatorSample sample() { return plant.sense(frame(), now_ns).actuators._buffer[0]; }
  erp::EcuFrame frame() const {
    erp::EcuFrame frame;
    frame.sequence = sequence, frame.stamp_ns = now_ns;
    erp::EcuChannelSample channel{};
    channel.fresh = true, channel.state = static_cast<std::uint8_t>(state);
    channel.zero_known = zero_known, channel.encoder_counts = counts() + zero_counts;
    channel.tension_counts = 819;
    erp::append(frame.channels, channel);
    if (!robot.joint_sensors.empty()) append_analog(frame, 0, joint_rad / (2 * M_PI) * 16384);
    if (!robot.potentiometers.empty())
      append_analog(frame, 1, (start_of_wiper - shaft_rad) / range_of_wiper * 4095);
    return frame;
  }
  static void append_analog(erp::EcuFrame& frame, std::uint8_t input, double counts) {
    erp::append(frame.analogs, erp::EcuAnalogSample{
                                   0, input, true, static_cast<std::int32_t>(std::lround(counts))});
  }
  bool reported(const std::string& code) const {
    return std::ranges::any_of(notices, [&](const auto& n) { return n.code == code; });
  }
  static constexpr double start_of_wiper = 31.4, range_of_wiper = 62.8;
};

erp::Robot with_potentiometer() {
  erp::Robot robot = one_muscle();
  erp::Potentiometer wiper;
  wiper.actuator = "flexor", wiper.ecu = 0, wiper.input = 1,
  wiper.range_rad = Robot::range_of_wiper;
  wiper.start_rad = Robot::start_of_wiper;
  robot.potentiometers.push_back(wiper);
  return robot;
}

erp::Robot with_joint_sensor(erp::SwitchedOn switched_on) {
  erp::Robot robot = one_muscle();
  robot.switched_on = switched_on;
  erp::Skeleton skeleton;
  erp::Joint joint;
  joint.name = "elbow", joint.type = erp::JointType::revolute, joint.initial_rad = 0.4;
  skeleton.joints.push_back(joint);
  robot.skeletons.push_back(skeleton);
  erp::JointSensor sensor;
  sensor.joint = "elbow", sensor.ecu = 0, sensor.input = 0;
  robot.joint_sensors.push_back(sensor);
  return robot;
}

double shaft_of(double line_m) { return -line_m / 0.0045; }

}  // namespace

TEST_CASE("after a reset with line wound up, length references are refused and nothing moves") {
  Robot rig(one_muscle());
  rig.shaft_rad = shaft_of(-wound_m);
  rig.reset();
  rig.ticks(3);
  rig.state = ECU_STATE_IDLE;
  for (int i = 0; i < 500; ++i) {
    rig.command(Mode::length, -wound_m);
    CHECK(rig.tick().request == ECU_REQUEST_OFF);
  }
  CHECK(rig.reported("zero_unknown"));
  CHECK(rig.plant.owners().actuators._buffer[0].refused == 500);
  const auto sample = rig.sample();
  CHECK((sample.valid & erp::valid::line) == 0);
  CHECK((sample.valid & erp::valid::shaft) == 0);
  CHECK((sample.valid & erp::valid::tension) != 0);
}

TEST_CASE("without a zero, force and voltage references are followed") {
  for (const Mode mode : {Mode::force, Mode::voltage}) {
    Robot rig(one_muscle());
    rig.ticks(3);
    rig.state = ECU_STATE_IDLE;
    rig.command(mode, 5);
    CHECK(rig.tick().request == ECU_REQUEST_ARM);
    rig.state = ECU_STATE_ARMED;
    rig.tick();
    rig.command(mode, 5);
    CHECK(rig.tick().request == sim::EcuUnits::request(mode));
  }
}

TEST_CASE("a reset in mid-run stops a length command that is being followed") {
  Robot rig(one_muscle());
  rig.zero_known = true, rig.state = ECU_STATE_ARMED;
  rig.tick();
  rig.command(Mode::length, -wound_m);
  CHECK(rig.tick().request == ECU_REQUEST_LENGTH);
  rig.shaft_rad = shaft_of(-wound_m);
  rig.reset();
  rig.state = ECU_STATE_RUNNING;  // the worst case: it runs at once
  rig.command(Mode::length, -wound_m);
  CHECK(rig.tick().request != ECU_REQUEST_LENGTH);
}

TEST_CASE("a potentiometer sets the zero by itself") {
  Robot rig(with_potentiometer());
  rig.shaft_rad = shaft_of(-wound_m);
  rig.reset();
  rig.ticks(3);
  rig.state = ECU_STATE_IDLE;
  rig.ticks(100);
  CHECK(rig.zero_known);
  CHECK(rig.sample().line_m == Approx(-wound_m).margin(0.0045 * Robot::range_of_wiper / 4095));
  CHECK(rig.reported("zero_set"));
  CHECK(rig.made_unknown == 0);
}

TEST_CASE("a potentiometer at the end of its range does not set the zero") {
  Robot rig(with_potentiometer());
  rig.shaft_rad = 40;
  rig.reset();
  rig.ticks(3);
  rig.state = ECU_STATE_IDLE;
  rig.ticks(200);
  CHECK_FALSE(rig.zero_known);
}

TEST_CASE("robot.xml states the starting pose: the joint sensors must agree") {
  Robot at_start(with_joint_sensor(erp::SwitchedOn::starting_pose));
  at_start.joint_rad = 0.41;
  at_start.ticks(3);
  at_start.state = ECU_STATE_IDLE;
  at_start.ticks(200);
  CHECK(at_start.zero_known);
  CHECK(at_start.sample().line_m == 0);

  Robot elsewhere(with_joint_sensor(erp::SwitchedOn::starting_pose));
  elsewhere.joint_rad = 0.5;
  elsewhere.ticks(3);
  elsewhere.state = ECU_STATE_IDLE;
  elsewhere.ticks(1000);
  CHECK_FALSE(elsewhere.zero_known);
  CHECK(elsewhere.reported("not_in_starting_pose"));

  Robot anywhere(with_joint_sensor(erp::SwitchedOn::anywhere));
  anywhere.joint_rad = 0.4;
  anywhere.ticks(3);
  anywhere.state = ECU_STATE_IDLE;
  anywhere.ticks(1000);
  CHECK_FALSE(anywhere.zero_known);
}

TEST_CASE("the starting pose is assumed once: not after a reset in mid-run") {
  Robot rig(with_joint_sensor(erp::SwitchedOn::starting_pose));
  rig.joint_rad = 0.4;
  rig.ticks(3);
  rig.state = ECU_STATE_IDLE;
  rig.ticks(200);
  REQUIRE(rig.zero_known);
  rig.shaft_rad = shaft_of(-wound_m);
  rig.reset();
  rig.ticks(3);
  rig.state = ECU_STATE_IDLE;
  rig.ticks(1000);
  CHECK_FALSE(rig.zero_known);
}

TEST_CASE("a restarted plant keeps the zero of a running ECU and assumes none") {
  Robot known(with_joint_sensor(erp::SwitchedOn::starting_pose));
  known.zero_known = true, known.state = ECU_STATE_RUNNING, known.shaft_rad = 3;
  known.ticks(500);
  CHECK(known.zeros_sent == 0);
  CHECK(known.sample().shaft_rad == Approx(3).margin(1e-4));

  Robot unknown(with_joint_sensor(erp::SwitchedOn::starting_pose));
  unknown.joint_rad = 0.4, unknown.state = ECU_STATE_RUNNING;
  unknown.ticks(500);
  CHECK_FALSE(unknown.zero_known);
}

TEST_CASE("a controller sets the zero; a known one is first made unknown") {
  Robot rig(one_muscle());
  rig.shaft_rad = 2.5;
  rig.reset();
  rig.ticks(3);
  rig.state = ECU_STATE_IDLE;
  rig.tick();
  rig.command(erp::set_zero_mode, -wound_m);
  rig.ticks(100);
  CHECK(rig.zero_known);
  CHECK(rig.sample().line_m == Approx(-wound_m).margin(1e-6));
  CHECK(rig.made_unknown == 0);
  rig.command(erp::set_zero_mode, 0.01);
  rig.ticks(200);
  CHECK(rig.zero_known);
  CHECK(rig.sample().line_m == Approx(0.01).margin(1e-6));
  CHECK(rig.made_unknown > 0);
}

TEST_CASE("a reset while the zero is being set drops it") {
  Robot rig(one_muscle());
  rig.ticks(3);
  rig.command(erp::set_zero_mode, -wound_m);  // in state boot: refused
  rig.state = ECU_STATE_IDLE;
  rig.tick();
  rig.command(erp::set_zero_mode, -wound_m);  // not yet sent to the ECU
  rig.shaft_rad = 1;
  rig.reset();
  rig.ticks(3);
  rig.state = ECU_STATE_IDLE;
  rig.ticks(200);
  CHECK(rig.zeros_sent == 0);
  CHECK_FALSE(rig.zero_known);
}

TEST_CASE("a zero beyond the spindle or not a number is refused") {
  for (const double line_m : {0.3, -0.3, std::nan("")}) {
    Robot rig(one_muscle());
    rig.ticks(3);
    rig.state = ECU_STATE_IDLE;
    rig.tick();
    rig.command(erp::set_zero_mode, line_m);
    rig.ticks(100);
    CHECK(rig.zeros_sent == 0);
    CHECK(rig.plant.owners().actuators._buffer[0].refused == 1);
  }
}

#include "components/gap_monitor/window.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/sim/gap/residuals/rig_recording.hpp"
#include "tests/sim/rigs.hpp"

namespace {

using rigs::hinge_rig;

/// A row of a recording as a sensor frame.
erp::SensorFrame frame_of(const recording::Table& table, const erp::Robot& robot, std::size_t row) {
  const auto value_of = [&](const std::string& name) { return table.find(name)->values[row]; };
  erp::SensorFrame frame;
  frame.stamp_ns = std::llround(1e9 * value_of("time_s")), frame.sequence = row;
  for (const erp::Actuator& a : robot.actuators) {
    erp::ActuatorSample s{};
    erp::assign(s.name, a.name);
    s.valid = erp::valid::all, s.mode = std::uint8_t(value_of(a.name + ".mode"));
    s.reference = value_of(a.name + ".reference"), s.voltage_V = value_of(a.name + ".voltage_V");
    s.current_A = value_of(a.name + ".current_A"), s.shaft_rad = value_of(a.name + ".shaft_rad");
    s.tension_N = value_of(a.name + ".tension_N");
    erp::append(frame.actuators, s);
  }
  erp::JointSample joint{};
  erp::assign(joint.name, "elbow");
  joint.valid = erp::valid::joint_angle, joint.angle_rad = value_of("elbow.angle_rad");
  erp::append(frame.joints, joint);
  return frame;
}

/// The stages with an open gap after a run of the rig with the given effects.
std::vector<std::string> open_stages(const std::vector<erp::Effect>& effects) {
  erp::Robot real = hinge_rig();
  real.effects = effects;
  const auto table = rig_recording::table_of_run(real, {.seconds = 5});
  gap_monitor::Window window(hinge_rig(), 4);
  std::string reason;
  constexpr std::size_t window_rows = 2000;  // 4 s
  for (std::size_t row = 0; row < table.rows(); ++row) {
    CHECK((row >= window_rows || window.evaluate(reason).empty()));
    window.receive(frame_of(table, real, row));
  }
  std::vector<std::string> open_gaps;
  const auto gaps = window.evaluate(reason);
  CHECK(reason.empty());
  CHECK_FALSE(gaps.empty());
  for (const auto& gap : gaps)
    if (gap.open) open_gaps.push_back(std::string(sim::effects::word(gap.stage)) + " " + gap.on);
  std::ranges::sort(open_gaps);
  return open_gaps;
}

}  // namespace

TEST_CASE(
    "no stage is open for a robot as modelled; friction in a gearbox opens the stage of that "
    "gearbox") {
  CHECK(open_stages({}).empty());
  CHECK(open_stages({{{}, "gearbox_coulomb", "extensor", {{{}, "extra_Nm", "0.03"}}}}) ==
        std::vector<std::string>{"gearbox extensor"});
}

TEST_CASE("a frame with an earlier stamp clears the window") {
  const erp::Robot robot = hinge_rig();
  const auto table = rig_recording::table_of_run(robot, {.seconds = 5});
  gap_monitor::Window window(robot, 4);
  for (std::size_t row = 0; row < table.rows(); ++row) window.receive(frame_of(table, robot, row));
  CHECK(window.full());
  for (std::size_t row = 0; row < 100; ++row) window.receive(frame_of(table, robot, row));
  CHECK(window.table().rows() == 100);
}

TEST_CASE(
    "the pose of a ball joint is that of motion capture, otherwise of the simulator, never of an "
    "estimator") {
  const erp::Robot robot = erp::read_robot(rigs::config("arm/robot.xml"));
  const auto joints = robot.joints();
  const auto ball =
      std::ranges::find(joints, erp::JointType::spherical, [](const auto& j) { return j.type; });
  gap_monitor::Window window(robot, 4);
  const auto position_after = [&](const char* source, double w) {
    erp::JointState state;
    erp::assign(state.source, source);
    erp::JointStateSample sample{};
    erp::assign(sample.name, ball->name);
    sample.position[0] = w;
    erp::append(state.joints, sample);
    window.receive(state), window.receive(erp::SensorFrame{});
    return window.table().find(ball->name + ".qw")->values.back();
  };
  CHECK(std::isnan(position_after("pose_estimator", 0.1)));
  CHECK(position_after("sim", 0.2) == 0.2);
  CHECK(position_after("motion_capture", 0.3) == 0.3);
  CHECK(std::isnan(position_after("sim", 0.4)));
}

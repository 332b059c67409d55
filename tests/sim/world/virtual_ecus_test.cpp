#include "sim/world/virtual_ecus.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <numbers>

#include "tests/sim/rigs.hpp"
#include "tests/sim/world/limb.hpp"

namespace {

using rigs::hinge_rig;

/// The flexor at `force_N`, the extensor at 2 N, for some ticks; set-points in mN.
void pull(Limb& limb, double force_N, int ticks) {
  for (int k = 0; k < ticks; ++k) {
    limb.command(ECU_REQUEST_FORCE, {1000 * force_N, 2000});
    limb.ecus.tick(limb.world);
  }
}

}  // namespace

TEST_CASE("without gains the ECUs stay in boot, apply no voltage and report their readings") {
  sim::World world(hinge_rig());
  sim::VirtualEcus ecus(hinge_rig());
  ecus.measure(world);
  erp::EcuFrame frame;
  ecus.fill(frame);
  REQUIRE(frame.channels._length == 2);
  REQUIRE(frame.analogs._length == 1);
  const erp::EcuChannelSample& flexor = frame.channels._buffer[0];
  CHECK(flexor.state == ECU_STATE_BOOT);
  CHECK(flexor.duty_counts == 0);
  CHECK(flexor.encoder_counts == 0);
  CHECK(flexor.tension_counts * 200.0 / 4095 == Approx(5).margin(0.3));
  CHECK(flexor.fresh);
}

TEST_CASE("gains designed for the second motor set meet the paper's figures") {
  erp::Robot robot = hinge_rig();
  const erp::Robot motors = erp::read_robot(rigs::config("parts/motors.xml"));
  robot.motor_types = motors.motor_types;
  for (auto& actuator : robot.actuators) actuator.motor = "geared_12V";
  Limb limb(robot, {.lock = {"elbow"}});
  pull(limb, 2, 500);
  pull(limb, 40, 500);
  double squares = 0;
  for (int k = 0; k < 1000; ++k) {
    pull(limb, 40, 1);
    squares += std::pow(limb.world.actuators()[0].tension_N - 40, 2) / 1000;
  }
  CHECK(std::sqrt(squares) <= 0.236);  // on the physical robot (paper, Fig. 6)
  CHECK(limb.all_running());
}

TEST_CASE(
    "a force step from 2 to 40 N on the rig's flexor with a locked elbow meets the paper's "
    "figures") {
  Limb limb(hinge_rig(), {.lock = {"elbow"}});
  pull(limb, 2, 500);
  double at_10 = -1, at_90 = -1, peak = 0, squares = 0;
  for (int k = 0; k < 500; ++k) {
    pull(limb, 40, 1);
    const double f = limb.world.actuators()[0].tension_N;
    if (at_10 < 0 && f > 5.8) at_10 = 0.002 * k;
    if (at_90 < 0 && f > 36.2) at_90 = 0.002 * k;
    peak = std::max(peak, f);
  }
  for (int k = 0; k < 1000; ++k) {
    pull(limb, 40, 1);
    squares += std::pow(limb.world.actuators()[0].tension_N - 40, 2) / 1000;
  }
  CHECK(at_90 - at_10 <= 0.200);
  CHECK(peak < 40.4);
  CHECK(std::sqrt(squares) <= 0.1);
  CHECK(limb.all_running());
}

TEST_CASE("without commands the channels trip and the voltage is zero") {
  Limb limb(hinge_rig());
  pull(limb, 10, 50);
  for (int k = 0; k < 30; ++k) limb.ecus.tick(limb.world);
  erp::EcuFrame frame;
  limb.ecus.fill(frame);
  CHECK(frame.channels._buffer[0].fault == ECU_FAULT_COMMAND_TIMEOUT);
  CHECK(frame.channels._buffer[0].duty_counts == 0);
}

TEST_CASE("sensors of ball joints, potentiometers and latency reach the frame") {
  erp::Robot robot = erp::read_robot(rigs::config("arm/robot.xml"));
  robot.joint_sensors = {{.joint = "shoulder", .about = erp::AxisName::y, .ecu = 0, .input = 0}};
  robot.potentiometers = {{.actuator = robot.actuators[0].name,
                           .ecu = 0,
                           .input = 2,
                           .bits = 16,
                           .range_rad = 60,
                           .start_rad = 30}};
  robot.potentiometers[0].sampling.latency_s = 0.003;
  Limb limb(robot);
  std::vector<double> lines(robot.actuators.size(), 0.0);
  lines[0] = -0.01;
  std::vector<double> shaft_rad{0};
  for (int k = 0; k < 200; ++k) {
    limb.follow_lines(lines);
    shaft_rad.push_back(limb.world.actuators()[0].shaft_rad);
  }
  erp::EcuFrame frame;
  limb.ecus.fill(frame);
  REQUIRE(frame.analogs._length == 2);
  const auto samples = erp::samples(frame.analogs);
  CHECK(samples[0].counts == std::lround(sim::angle_rad(limb.world.joints()[0], erp::AxisName::y) /
                                         (2 * std::numbers::pi) * 16384));
  const double measured_rad = 30 - samples[1].counts * 60.0 / 65535;  // 3 ms ago: between two ticks
  CHECK(measured_rad <= std::max(shaft_rad[198], shaft_rad[199]) + 1e-3);
  CHECK(measured_rad >= std::min(shaft_rad[198], shaft_rad[199]) - 1e-3);
}

TEST_CASE("the joint sensor's counts are the joint's angle") {
  erp::Robot rig = hinge_rig();
  rig.joint_sensors[0].noise_rad = 0;
  Limb limb(rig);
  pull(limb, 30, 200);
  erp::EcuFrame frame;
  limb.ecus.fill(frame);
  const double angle = limb.world.joints()[0].position[0];
  REQUIRE(angle > 0.1);
  CHECK(frame.analogs._buffer[0].counts * 2 * M_PI / 16384 == Approx(angle).margin(2e-4));
}

TEST_CASE("two runs with the same seed give the same frames, and another seed gives other frames") {
  const auto run = [](std::uint64_t seed) {
    Limb limb(hinge_rig(), {}, {.seed = seed});
    std::vector<erp::EcuChannelSample> trace;
    erp::EcuFrame frame;
    for (int k = 0; k < 300; ++k) {
      pull(limb, 10 + 5 * std::sin(0.02 * k), 1);
      limb.ecus.fill(frame);
      trace.push_back(frame.channels._buffer[0]);
    }
    return trace;
  };
  const auto same = [](const auto& a, const auto& b) {
    return std::equal(a.begin(), a.end(), b.begin(), [](const auto& x, const auto& y) {
      return x.encoder_counts == y.encoder_counts && x.current_counts == y.current_counts &&
             x.tension_counts == y.tension_counts && x.duty_counts == y.duty_counts;
    });
  };
  CHECK(same(run(7), run(7)));
  CHECK_FALSE(same(run(7), run(8)));
}

TEST_CASE("with a physics step of 0.2 ms instead of 1 ms the angle changes by less than 2 mrad") {
  const auto angle = [](int substeps) {
    Limb limb(hinge_rig(), {.usual_step_s = 0.002 / substeps}, {.substeps = substeps});
    pull(limb, 20, 500);
    return limb.world.joints()[0].position[0];
  };
  CHECK(angle(2) == Approx(angle(10)).margin(2e-3));
}

TEST_CASE("a joint sensor on an unknown joint, and less than one substep, are rejected") {
  erp::Robot rig = hinge_rig();
  rig.joint_sensors[0].joint = "knee";
  CHECK_THROWS_AS(sim::VirtualEcus(rig), std::invalid_argument);
  CHECK_THROWS_AS(sim::VirtualEcus(hinge_rig(), {.substeps = 0}), std::invalid_argument);
}

#include "sim/model/actuator/sensors.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/sim/rigs.hpp"

using sim::ActuatorSensors, sim::JointAngleSensor;

namespace {

erp::SensorType ecu_12bit(double current_noise_A = 0, double tension_noise_N = 0) {
  erp::SensorType s;
  s.encoder_counts_per_rev = 2048, s.current_bits = 12, s.tension_bits = 12;
  s.current_range_A = 8, s.tension_range_N = 200;
  s.current_noise_A = current_noise_A, s.tension_noise_N = tension_noise_N;
  return s;
}

}  // namespace

TEST_CASE("one motor revolution is 2048 counts") {
  ActuatorSensors sensors(rigs::caliper(), ecu_12bit(), 1);
  CHECK(sensors.read(2 * std::numbers::pi / 128, 0, 0).encoder == 2048);
  CHECK(sensors.read(-2 * std::numbers::pi, 0, 0).encoder == -2048 * 128);
}

TEST_CASE("current and tension are read within half a quantization step") {
  ActuatorSensors sensors(rigs::caliper(), ecu_12bit(), 1);
  const auto& scale = sensors.scale();
  CHECK(scale.current_A_per_count == Approx(16.0 / 4096));
  CHECK(scale.tension_N_per_count == Approx(200.0 / 4095));
  for (double x = -7.9; x < 7.9; x += 0.0137)
    REQUIRE(std::abs(sensors.read(0, x, 0).current * scale.current_A_per_count - x) <=
            0.5001 * scale.current_A_per_count);
  for (double f = 0; f < 200; f += 0.37)
    REQUIRE(std::abs(sensors.read(0, 0, f).tension * scale.tension_N_per_count - f) <=
            0.5001 * scale.tension_N_per_count);
}

TEST_CASE("outside its range a converter saturates") {
  ActuatorSensors sensors(rigs::caliper(), ecu_12bit(), 1);
  CHECK(sensors.read(0, 100, 1000).current == 2047);
  CHECK(sensors.read(0, 100, 1000).tension == 4095);
  CHECK(sensors.read(0, -100, -5).current == -2048);
  CHECK(sensors.read(0, -100, -5).tension == 0);
}

TEST_CASE("the noise has the specified standard deviation and is reproducible from the seed") {
  ActuatorSensors sensors(rigs::caliper(), ecu_12bit(0.015, 0.05), 42);
  ActuatorSensors equal_seed(rigs::caliper(), ecu_12bit(0.015, 0.05), 42);
  ActuatorSensors other_seed(rigs::caliper(), ecu_12bit(0.015, 0.05), 43);
  double sum = 0, squares = 0;
  int differ = 0;
  const int samples = 20000;
  for (int k = 0; k < samples; ++k) {
    const auto counts = sensors.read(0, 1.0, 50), repeated = equal_seed.read(0, 1.0, 50);
    REQUIRE(counts.current == repeated.current);
    REQUIRE(counts.tension == repeated.tension);
    differ += counts.current != other_seed.read(0, 1.0, 50).current;
    const double error = counts.current * sensors.scale().current_A_per_count - 1.0;
    sum += error, squares += error * error;
  }
  const double quantum = sensors.scale().current_A_per_count;
  CHECK(std::sqrt(squares / samples) ==
        Approx(std::hypot(0.015, quantum / std::sqrt(12.0))).epsilon(0.02));
  CHECK(std::abs(sum / samples) < 4 * 0.015 / std::sqrt(samples));
  CHECK(differ > samples / 2);
}

TEST_CASE(
    "the sensor of a ball joint reads one component of the rotation vector and saturates at its "
    "limits") {
  const Eigen::Vector3d turn(0.3, -0.5, 0.2);
  const Eigen::Quaterniond q(Eigen::AngleAxisd(turn.norm(), turn.normalized()));
  const sim::JointReading ball{
      erp::JointType::spherical, {-q.w(), -q.x(), -q.y(), -q.z()}, {}, {}, {}};
  CHECK(sim::angle_rad(ball, erp::AxisName::x) == Approx(0.3));
  CHECK(sim::angle_rad(ball, erp::AxisName::y) == Approx(-0.5));
  CHECK(sim::angle_rad(ball, erp::AxisName::z) == Approx(0.2));
  erp::JointSensor type;
  type.about = erp::AxisName::y, type.min_rad = -0.25;
  CHECK(JointAngleSensor(type, 1).read(ball) ==
        std::lround(-0.25 / (2 * std::numbers::pi) * 16384));
}

TEST_CASE("the potentiometer follows eq. 5 from its start to its limits") {
  erp::Potentiometer type;
  type.bits = 12, type.range_rad = 20, type.start_rad = 8;
  sim::PotentiometerSensor sensor(type, 1);
  const double r = 0.0045, line_m = -0.018;  // wound up by 4 rad
  const double degrees = 180 * (line_m / (std::numbers::pi * r)) + 8 * 180 / std::numbers::pi;
  const double read_rad = sensor.read(-line_m / r) * 20.0 / 4095;
  CHECK(read_rad * 180 / std::numbers::pi == Approx(degrees).margin(0.5 * 20 / 4095 * 57.3));
  CHECK(sensor.read(9) == 0);
  CHECK(sensor.read(-13) == 4095);
}

TEST_CASE("the joint sensor has 14 bits per revolution, also beyond one turn") {
  erp::JointSensor type;
  type.bits_per_rev = 14;
  JointAngleSensor sensor(type, 1);
  const auto at = [](double angle) {
    return sim::JointReading{erp::JointType::revolute, {angle}, {}, {}, {}};
  };
  CHECK(sensor.read(at(std::numbers::pi)) == 8192);
  CHECK(sensor.read(at(-3 * std::numbers::pi)) == -24576);
}

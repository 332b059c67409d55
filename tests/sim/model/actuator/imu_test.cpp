#include "sim/model/actuator/imu.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

using sim::BodyPose, sim::BodyTwist, sim::ImuReading, sim::ImuSensor, sim::Vec3;

namespace {

const Vec3 gravity(0, 0, -9.81);

erp::Imu unit() {
  erp::Imu imu;
  imu.bits = 24;
  imu.acceleration_range_m_per_s2 = 40, imu.turning_range_rad_per_s = 20;
  return imu;
}

}  // namespace

TEST_CASE("at rest the IMU reads minus gravity in its own axes") {
  BodyPose pose;
  pose.rotation = Eigen::AngleAxisd(0.5, Vec3::UnitX()).toRotationMatrix();
  ImuSensor sensor(unit(), gravity, 1);
  for (double t = 0; t < 0.01; t += 0.002) {
    const ImuReading reading = sensor.sample(t, pose, {});
    CHECK((reading.acceleration_m_per_s2 - pose.rotation.transpose() * Vec3(0, 0, 9.81)).norm() <
          1e-5);
    CHECK(reading.turning_rad_per_s.norm() < 1e-5);
  }
}

TEST_CASE("on a rotating body the IMU reads ω² r towards the axis") {
  erp::Imu imu = unit();
  imu.at_m = {0.2, 0, 0};
  ImuSensor sensor(imu, Vec3::Zero(), 1);
  const double omega = 3, dt = 1e-4;
  ImuReading reading;
  for (int k = 0; k < 1000; ++k) {
    BodyPose pose;
    pose.rotation = Eigen::AngleAxisd(omega * dt * k, Vec3::UnitZ()).toRotationMatrix();
    reading = sensor.sample(dt * k, pose, {Vec3(0, 0, omega), Vec3::Zero()});
  }
  CHECK(reading.acceleration_m_per_s2.x() == Approx(-omega * omega * 0.2).epsilon(1e-3));
  CHECK(reading.turning_rad_per_s.z() == Approx(omega).epsilon(1e-5));
}

TEST_CASE("an IMU in free fall reads zero, and out of range it saturates") {
  ImuSensor sensor(unit(), gravity, 1);
  sensor.sample(0, {}, {});
  CHECK(sensor.sample(0.01, {}, {Vec3::Zero(), 0.01 * gravity}).acceleration_m_per_s2.norm() <
        1e-5);
  CHECK(sensor.sample(0.02, {}, {Vec3(0, 0, 50), Vec3(9, 0, 0)}).acceleration_m_per_s2.x() == 40);
  CHECK(sensor.sample(0.03, {}, {Vec3(0, 0, 50), Vec3(9, 0, 0)}).turning_rad_per_s.z() == 20);
}

TEST_CASE("noise has the standard deviation of the XML and is reproducible from the seed") {
  erp::Imu imu = unit();
  imu.acceleration_noise_m_per_s2 = 0.05, imu.turning_noise_rad_per_s = 0.01;
  ImuSensor sensor(imu, Vec3::Zero(), 7), second_sensor(imu, Vec3::Zero(), 7);
  double squares = 0;
  constexpr int samples = 20000;
  for (int k = 0; k < samples; ++k) {
    const ImuReading reading = sensor.sample(0.01 * k, {}, {});
    REQUIRE(reading.acceleration_m_per_s2 ==
            second_sensor.sample(0.01 * k, {}, {}).acceleration_m_per_s2);
    squares += reading.acceleration_m_per_s2.squaredNorm() / 3;
  }
  CHECK(std::sqrt(squares / samples) == Approx(0.05).epsilon(0.02));
}

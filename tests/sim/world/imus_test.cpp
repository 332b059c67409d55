#include "sim/world/imus.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <map>

#include "tests/sim/rigs.hpp"

namespace {

erp::Imu unit(const std::string& name, double rate_Hz, double latency_s) {
  erp::Imu imu;
  imu.name = name, imu.body = "forearm", imu.at_m = {0, 0, -0.1}, imu.bits = 24;
  imu.acceleration_range_m_per_s2 = 40, imu.turning_range_rad_per_s = 20;
  imu.sampling = {rate_Hz, latency_s};
  return imu;
}

}  // namespace

TEST_CASE(
    "inertial units sample at their rates and arrive after their latency with the sampling time") {
  erp::Robot robot = erp::read_robot(rigs::config("hinge_rig/robot.xml"));
  robot.imus = {unit("quick", 500, 0), unit("slow", 100, 0.004), unit("other", 100, 0.004)};
  sim::World world(robot);
  sim::Imus imus(world, 1, 0.002);
  std::map<std::string, std::vector<std::int64_t>> stamps;
  erp::ImuFrame frame;
  for (int tick = 0; tick <= 5000; ++tick) {
    imus.sample(world);
    while (imus.next(frame)) {
      for (const auto& sample : erp::samples(frame.imus)) {
        stamps[sample.name].push_back(frame.stamp_ns);
        const double delay_s = world.time_s() - 1e-9 * double(frame.stamp_ns);
        REQUIRE(std::abs(delay_s - (std::string("quick") == sample.name ? 0 : 0.004)) < 1e-8);
      }
    }
    for (int k = 0; k < 2; ++k) world.step(std::vector<double>(2, 0.0), 0.001);
  }
  REQUIRE(stamps["quick"].size() == 5001);
  REQUIRE(stamps["slow"].size() == 1000);
  CHECK(stamps["slow"] == stamps["other"]);
  for (std::size_t k = 0; k < 1000; ++k)
    REQUIRE(std::llabs(stamps["slow"][k] - 10'000'000 * std::int64_t(k)) < 10);
  // The forearm hangs: the reaction to gravity, along its z.
  REQUIRE(frame.imus._length > 0);
  CHECK(frame.imus._buffer[0].acceleration_m_per_s2[2] == Approx(9.81).epsilon(1e-3));
}

TEST_CASE("an inertial unit on an unknown body is rejected") {
  erp::Robot robot = erp::read_robot(rigs::config("hinge_rig/robot.xml"));
  robot.imus = {unit("lost", 100, 0)};
  robot.imus[0].body = "hand";
  CHECK_THROWS_WITH(sim::Imus(sim::World(robot), 1, 0.002), Catch::Contains("hand"));
}

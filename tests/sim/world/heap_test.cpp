// A separate program, because it counts every allocation.
#include <catch2/catch.hpp>

#include "sim/world/imus.hpp"
#include "tests/allocations.hpp"
#include "tests/sim/rigs.hpp"
#include "tests/sim/world/limb.hpp"

TEST_CASE("ropes on bodies, timed sensors and inertial units do not use the heap") {
  erp::Robot robot = erp::read_robot(rigs::config("hinge_rig/robot.xml"));
  auto& path = robot.actuators[0].tendon.path;
  path = {path.front(), path[path.size() - 2], path.back()};
  robot.actuators[0].rope = erp::Rope{{}, 60, 0.004, 0, 0.1, ""};
  for (auto& type : robot.sensor_types) type.sampling = {250, 0.007};
  erp::Imu imu;
  imu.name = "imu", imu.body = "forearm", imu.acceleration_range_m_per_s2 = 40;
  imu.turning_range_rad_per_s = 20, imu.sampling = {100, 0.004};
  robot.imus = {imu};
  Limb limb(robot);
  sim::Imus imus(limb.world, 1, 0.002);
  erp::ImuFrame frame;
  const auto tick = [&] {
    limb.follow_lines({-0.005, 0.005});
    imus.sample(limb.world);
    while (imus.next(frame)) {
    }
  };
  for (int k = 0; k < 50; ++k) tick();
  REQUIRE(limb.world.rope(0)->forces().size() > 3);
  const std::size_t before = tests::allocations();
  for (int k = 0; k < 100; ++k)
    limb.ecus.tick(limb.world), imus.sample(limb.world), imus.next(frame);
  const std::size_t after = tests::allocations();
  CHECK(after == before);
}

TEST_CASE("a tick of the arm, its ECUs and its frame does not use the heap") {
  Limb limb(erp::read_robot(rigs::config("arm/robot.xml")));
  erp::EcuFrame frame;
  erp::JointState joints;
  erp::BodyPose bodies;
  const auto tick = [&] {
    limb.ecus.tick(limb.world);
    limb.ecus.fill(frame);
    limb.world.fill(joints);
    limb.world.fill(bodies);
  };
  for (int k = 0; k < 10; ++k) tick();
  const std::size_t before = tests::allocations();
  for (int k = 0; k < 100; ++k) tick();
  const std::size_t after = tests::allocations();
  CHECK(after == before);
}

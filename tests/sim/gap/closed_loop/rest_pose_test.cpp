#include "sim/gap/closed_loop/rest_pose.hpp"

#include <catch2/catch.hpp>

#include "sim/control/equilibrium.hpp"
#include "tests/sim/learning/calibration/arm_poses.hpp"

TEST_CASE("the simulated rest pose of the arm agrees with its static equilibrium within 0.01 rad") {
  const erp::Robot arm = arm_poses::arm();
  std::vector<std::vector<double>> shafts_rad;
  for (const auto& still : arm_poses::held_poses(arm, 4)) shafts_rad.push_back(still.shaft_rad);
  sim::Equilibrium equilibrium(arm);
  const auto rest_poses = sim::closed_loop::rest_poses(arm, shafts_rad);
  REQUIRE(rest_poses.size() == 4);
  for (std::size_t k = 0; k < 4; ++k) {
    CHECK(rest_poses[k].at_rest);
    const auto rest = equilibrium.find(shafts_rad[k], sim::starting_pose(arm)).pose;
    const auto turn = sim::displacement(erp::JointType::spherical, rest[0], rest_poses[k].pose[0]);
    CHECK(std::hypot(turn[0], turn[1], turn[2]) < 0.01);
    CHECK(rest_poses[k].pose[1][0] == Approx(rest[1][0]).margin(0.01));
  }
}

TEST_CASE("a pose that is not reached within the longest simulation is reported as not at rest") {
  const erp::Robot arm = arm_poses::arm();
  const std::vector<std::vector<double>> shafts_rad{std::vector<double>(11, 3.0)};
  const auto rest_poses = sim::closed_loop::rest_poses(arm, shafts_rad, {.longest_s = 0.5});
  CHECK_FALSE(rest_poses.front().at_rest);
}

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "sim/control/pose_plan.hpp"
#include "tests/sim/rigs.hpp"
#include "tests/sim/world/limb.hpp"

namespace {

constexpr double degree = std::numbers::pi / 180;

erp::Robot arm() { return erp::read_robot(rigs::config("arm/robot.xml")); }

/// The fifteen poses to be held.
std::vector<sim::Pose> arm_poses() {
  std::vector<sim::Pose> poses;
  const auto rows = sim::poses_of(recording::read_table(rigs::config("arm/poses.csv")), arm());
  for (std::size_t k = 1; k < rows.size(); ++k)
    if (rows[k].pose == rows[k - 1].pose) poses.push_back(rows[k].pose);
  return poses;
}

Eigen::Quaterniond turn(const std::array<double, 4>& p) { return {p[0], p[1], p[2], p[3]}; }

/// Distance of two poses: the larger angle of shoulder and elbow.
double pose_distance_rad(const sim::Pose& a, const sim::Pose& b) {
  return std::max(turn(a[0]).angularDistance(turn(b[0])), std::abs(a[1][0] - b[1][0]));
}

sim::Pose pose_of(const sim::World& world) {
  return {world.joints()[0].position, world.joints()[1].position};
}

struct Hold {
  double drift_rad = 0, error_rad = 0;
};

/// Ramps in 1.5 s, settles, then measures for 3 s.
Hold hold(Limb& limb, const std::vector<double>& from, const std::vector<double>& to,
          const sim::Pose& desired, double settle_s = 1) {
  std::vector<double> lines = from;
  for (int k = 0; k <= std::lround((1.5 + settle_s) / 0.002); ++k) {
    for (std::size_t i = 0; i < lines.size(); ++i)
      lines[i] = from[i] + sim::minimum_jerk(k / 750.0).fraction * (to[i] - from[i]);
    limb.follow_lines(lines);
  }
  const sim::Pose settled = pose_of(limb.world);
  Hold result;
  for (int k = 0; k < 1500; ++k) {
    limb.follow_lines(to);
    result.drift_rad = std::max(result.drift_rad, pose_distance_rad(pose_of(limb.world), settled));
  }
  result.error_rad = pose_distance_rad(pose_of(limb.world), desired);
  return result;
}

}  // namespace

TEST_CASE("the arm has eleven muscles, two of them over both joints") {
  const erp::Robot robot = arm();
  REQUIRE(robot.actuators.size() == 11);
  int biarticular = 0;
  for (const auto& actuator : robot.actuators) {
    bool torso = false, forearm = false;
    for (const auto& element : actuator.tendon.path)
      std::visit([&](const auto& e) { torso |= e.body == "torso", forearm |= e.body == "forearm"; },
                 element);
    biarticular += torso && forearm;
  }
  CHECK(biarticular == 2);
}

TEST_CASE("no muscle's path point is inside a pulley in any of the poses") {
  const erp::Robot robot = arm();
  sim::World world(robot);
  for (const sim::Pose& pose : arm_poses()) {
    world.set_joint(0, {erp::JointType::spherical, pose[0], {}});
    world.set_joint(1, {erp::JointType::revolute, pose[1], {}});
    for (std::size_t k = 0; k < robot.actuators.size(); ++k)
      for (int e = 0; e < world.path(int(k)).elements; ++e)
        CHECK_FALSE(world.path(int(k)).inside[e]);
  }
}

TEST_CASE("under length control the arm stays at its initial pose") {
  const erp::Robot robot = arm();
  Limb limb(robot);
  const std::vector<double> start(11, 0.0);
  const Hold result = hold(limb, start, start, sim::starting_pose(robot));
  CAPTURE(result.drift_rad / degree, result.error_rad / degree);
  CHECK(limb.all_running());
  CHECK(result.drift_rad < 0.05 * degree);
  CHECK(result.error_rad < 1 * degree);
}

TEST_CASE("under length control of all muscles the arm holds fifteen poses without drift") {
  erp::Robot robot = arm();
  const bool has_friction = GENERATE(
      true, false);  // without friction only the muscles hold the arm, and it oscillates longer
  if (!has_friction)
    for (auto& joint : robot.skeletons[0].joints) joint.coulomb_Nm = 0;
  const auto poses = arm_poses();
  REQUIRE(poses.size() == 15);
  Limb limb(robot);
  std::vector<double> from(11, 0.0);
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const auto to = sim::hold_pose(robot, poses[k]).line_m;
    const Hold held = hold(limb, from, to, poses[k], has_friction ? 1 : 4);
    CAPTURE(k, held.drift_rad / degree, held.error_rad / degree);
    CHECK(limb.all_running());
    CHECK(held.drift_rad < 0.2 * degree);
    CHECK(held.error_rad < 0.5 * degree);
    from = to;
  }
}

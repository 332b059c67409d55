#include "sim/control/pose_plan.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <sstream>

#include "interfaces/recording/csv.hpp"
#include "tests/sim/rigs.hpp"

using recording::parse_csv, recording::Table;
using sim::lengths_through, sim::poses_of;

TEST_CASE("lengths.csv of each robot is the output of erp model lengths for its poses.csv") {
  const auto* name =
      GENERATE("arm", "twin_joint", "seven_dof", "pendulum", "ecce1", "ecce2", "ecce3", "ecce4");
  CAPTURE(name);
  const std::string folder = rigs::config(name);
  const erp::Robot robot = erp::read_robot(folder + "/robot.xml");
  const auto poses = poses_of(recording::read_table(folder + "/poses.csv"), robot);
  const bool torso = std::string(name).starts_with("ecce");
  const sim::PlanOptions options{
      .holding = {.rest_N = torso ? 20.0 : 10, .least_N = torso ? 8.0 : 5}};
  const Table computed = lengths_through(robot, poses, options).table;
  const Table stored = recording::read_table(folder + "/lengths.csv");
  REQUIRE(stored.columns.size() == computed.columns.size());
  REQUIRE(stored.rows() == computed.rows());
  for (std::size_t c = 0; c < computed.columns.size(); ++c)
    for (std::size_t row = 0; row < computed.rows(); ++row)
      REQUIRE(std::abs(stored.columns[c].values[row] - computed.columns[c].values[row]) < 1e-6);
}

TEST_CASE(
    "joints without a column keep their starting position, and empty cells keep the previous "
    "value") {
  const erp::Robot robot = erp::read_robot(rigs::config("arm/robot.xml"));
  const auto poses =
      poses_of(parse_csv("poses.csv", "time_s,elbow.angle_rad\n0,0.5\n1,\n2,0.7\n"), robot);
  REQUIRE(poses.size() == 3);
  CHECK(poses[0].pose[0] == std::array<double, 4>{1, 0, 0, 0});
  CHECK(poses[1].pose[1][0] == 0.5);
  CHECK(poses[2].pose[1][0] == 0.7);
  CHECK(poses[2].time_s == 2);
}

TEST_CASE(
    "poses out of range or with an invalid quaternion are rejected with row, joint and value") {
  const erp::Robot robot = erp::read_robot(rigs::config("arm/robot.xml"));
  const auto check_rejected = [&](const std::string& csv) {
    CHECK_THROWS_WITH(poses_of(parse_csv("poses.csv", csv), robot), Catch::Contains("row 2"));
  };
  check_rejected("time_s,elbow.angle_rad\n0,0.5\n1,9\n");
  check_rejected("time_s,shoulder.qw\n0,1\n1,0.5\n");
}

TEST_CASE("sensor columns of ball joints in a recording are ignored without an error") {
  erp::Robot robot = erp::read_robot(rigs::config("arm/robot.xml"));
  robot.joint_sensors = {{.joint = "shoulder", .about = erp::AxisName::x}};
  CHECK(poses_of(parse_csv("poses.csv", "time_s,shoulder_x.angle_rad\n0,0.5\n"), robot).size() ==
        1);
}

TEST_CASE("turns around a pulley are counted from pose to pose") {
  erp::Robot robot = erp::read_robot(rigs::config("hinge_rig/robot.xml"));
  robot.skeletons[0].joints[0].min_rad = -20, robot.skeletons[0].joints[0].max_rad = 20;
  auto& path = robot.actuators[0].tendon.path;
  auto& pulley = std::get<erp::Pulley>(path[path.size() - 2]);
  pulley.side = {0, 0, 0}, pulley.axis = {0, -1, 0}, pulley.turns = 2;
  const auto poses =
      poses_of(parse_csv("poses.csv", "time_s,elbow.angle_rad\n0,0\n3,12\n6,-6\n"), robot);
  const Table plan = lengths_through(robot, poses).table;
  const auto& line = plan.find("flexor.reference")->values;
  for (std::size_t row = 1; row < line.size(); ++row)
    REQUIRE(std::abs(line[row] - line[row - 1]) < 0.025);  // less than 1 rad of the elbow
}

TEST_CASE("a column that belongs to no joint is rejected with the nearest name") {
  const erp::Robot robot = erp::read_robot(rigs::config("arm/robot.xml"));
  const Table table = parse_csv("poses.csv", "time_s,elbo.angle_rad\n0,0.5\n");
  CHECK_THROWS_WITH(poses_of(table, robot),
                    Catch::Contains("elbo.angle_rad") && Catch::Contains("elbow.angle_rad"));
}

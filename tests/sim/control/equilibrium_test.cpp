#include "sim/control/equilibrium.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "sim/control/holding.hpp"
#include "sim/model/actuator/spring.hpp"
#include "tests/sim/rigs.hpp"

namespace {

/// Shaft angles that hold a pose, from the line lengths of statics.
std::vector<double> shafts_for(const erp::Robot& robot, const sim::Pose& pose) {
  const auto holding = sim::hold_pose(robot, pose);
  REQUIRE(holding.unbalanced_Nm < 1e-4);
  std::vector<double> shaft_rad;
  for (std::size_t a = 0; a < robot.actuators.size(); ++a)
    shaft_rad.push_back(-holding.line_m[a] / robot.actuators[a].spindle.radius_m);
  return shaft_rad;
}

sim::Pose arm_at(double turn_rad, double elbow_rad) {
  const double half = turn_rad / 2;
  return {{std::cos(half), 0.6 * std::sin(half), 0.8 * std::sin(half), 0}, {elbow_rad}};
}

}  // namespace

TEST_CASE(
    "with the shaft angles of a held pose the equilibrium is that pose, from any initial pose") {
  const erp::Robot robot = erp::read_robot(rigs::config("arm/robot.xml"));
  sim::Equilibrium equilibrium(robot);
  for (const double turn : {-0.3, 0.2, 0.5})
    for (const double elbow : {0.5, 1.2}) {
      const auto pose = arm_at(turn, elbow);
      const auto shafts = shafts_for(robot, pose);
      for (const auto& from : {pose, arm_at(turn + 0.2, elbow - 0.2)}) {
        const auto rest = equilibrium.find(shafts, from);
        CHECK(rest.unbalanced_Nm < 1e-6);
        const auto deviation = sim::displacement(erp::JointType::spherical, pose[0], rest.pose[0]);
        CHECK(std::hypot(deviation[0], deviation[1], deviation[2]) < 1e-5);
        CHECK(rest.pose[1][0] == Approx(elbow).margin(1e-5));
      }
    }
}

TEST_CASE("a hinge that tendons pull beyond its range is in equilibrium at its stop") {
  erp::Robot robot = erp::read_robot(rigs::config("hinge_rig/robot.xml"));
  sim::Equilibrium equilibrium(robot);
  const auto start = sim::starting_pose(robot);
  const auto rest = equilibrium.find(std::vector<double>{20, -20}, start);
  const auto joint = robot.joints().front();
  CHECK((rest.pose[0][0] == joint.max_rad || rest.pose[0][0] == joint.min_rad));
  CHECK(rest.unbalanced_Nm < 1e-6);
}

TEST_CASE("additional path length is equivalent to additional winding of the shaft") {
  const erp::Robot robot = erp::read_robot(rigs::config("arm/robot.xml"));
  const auto pose = arm_at(0.2, 0.8);
  auto shafts = shafts_for(robot, pose);
  std::vector<double> longer_m(robot.actuators.size());
  longer_m[7] = 0.004;
  shafts[7] -= 0.004 / robot.actuators[7].spindle.radius_m;
  const auto rest = sim::Equilibrium(robot, longer_m).find(shafts, pose);
  CHECK(rest.pose[1][0] == Approx(0.8).margin(1e-5));
}

TEST_CASE("the energy of a spring is the work of its force") {
  for (const sim::Spring spring :
       {sim::Spring{6000}, sim::Spring{6000, 4e7}, sim::Spring{6000, 4e7, 1e-5}}) {
    double sum = 0;
    constexpr double h = 1e-6;
    for (double x = h / 2; x < 0.01; x += h) sum += h * spring.force_N(x);
    CHECK(spring.energy_J(0.01) == Approx(sum).epsilon(1e-6));
    CHECK(spring.energy_J(-0.01) == 0);
  }
}

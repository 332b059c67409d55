#include "sim/control/tension_distribution.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "sim/model/actuator/musculoskeletal.hpp"
#include "tests/sim/rigs.hpp"

namespace {

using Eigen::VectorXd;

struct Arm {
  erp::Robot robot = erp::read_robot(rigs::config("arm/robot.xml"));
  sim::Musculoskeletal model{robot};
  sim::TensionDistribution distribution(sim::TensionObjective objective, double least_N = 5) const {
    return {sim::objective_terms(robot, objective, least_N), model.coordinates()};
  }
  VectorXd gravity_Nm() {
    VectorXd torque;
    model.skeleton().gravity_torques(torque);
    return torque;
  }
};

double copper_W(const erp::Robot& robot, const VectorXd& f) {
  double sum = 0;
  for (std::size_t a = 0; a < robot.actuators.size(); ++a) {
    const auto& motor = robot.motor_of(robot.actuators[a]);
    const double i = f[Eigen::Index(a)] * robot.actuators[a].spindle.radius_m /
                     (motor.gear_efficiency * motor.gear_ratio * motor.torque_Nm_per_A);
    sum += motor.resistance_ohm * i * i;
  }
  return sum;
}

}  // namespace

TEST_CASE("the tensions produce the torque and are at or above the lower bound") {
  Arm arm;
  for (const auto objective :
       {sim::TensionObjective::least_tension, sim::TensionObjective::least_energy,
        sim::TensionObjective::least_activation, sim::TensionObjective::smooth}) {
    auto distribution = arm.distribution(objective);
    const VectorXd torque = arm.gravity_Nm();
    const VectorXd f = distribution.distribute(arm.model.jacobian(), torque);
    CHECK((arm.model.jacobian().transpose() * f + torque).norm() < 1e-5 * torque.norm() + 1e-6);
    CHECK(distribution.missing().norm() < 1e-5);
    CHECK(f.minCoeff() >= 5);
    CHECK(f.maxCoeff() <= 300);
  }
}

TEST_CASE("each objective has the smallest value of its own cost") {
  Arm arm;
  const VectorXd torque = arm.gravity_Nm();
  const auto& l = arm.model.jacobian();
  const VectorXd tension =
      arm.distribution(sim::TensionObjective::least_tension).distribute(l, torque);
  const VectorXd energy =
      arm.distribution(sim::TensionObjective::least_energy).distribute(l, torque);
  CHECK(energy.squaredNorm() == Approx(tension.squaredNorm()).epsilon(0.2));
  CHECK(copper_W(arm.robot, energy) <= copper_W(arm.robot, tension) + 1e-9);
  CHECK((tension.array() - 5).matrix().norm() <= (energy.array() - 5).matrix().norm() + 1e-9);
}

TEST_CASE("for an infeasible torque the error is minimal") {
  Arm arm;
  auto distribution = arm.distribution(sim::TensionObjective::least_tension);
  const auto& l = arm.model.jacobian();
  const VectorXd torque = 40 * arm.gravity_Nm();
  const VectorXd f = distribution.distribute(l, torque);
  const double residual_norm = distribution.missing().norm();
  CHECK(residual_norm > 1);
  CHECK((distribution.missing() - l.transpose() * f - torque).norm() < 1e-9);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any_tension(5, 300), near(-1, 1);
  for (int k = 0; k < 2000; ++k) {
    const VectorXd other =
        k % 2 ? VectorXd::NullaryExpr(11, [&] { return any_tension(random); })
              : VectorXd((f + VectorXd::NullaryExpr(11, [&] { return near(random); }))
                             .cwiseMax(5)
                             .cwiseMin(300));
    REQUIRE((l.transpose() * other + torque).norm() >= residual_norm - 1e-6);
  }
}

TEST_CASE("the other tendons compensate a lost tendon as far as possible") {
  Arm arm;
  auto distribution = arm.distribution(sim::TensionObjective::least_tension);
  const VectorXd torque = 2 * arm.gravity_Nm();
  const VectorXd with_all_tendons = distribution.distribute(arm.model.jacobian(), torque);
  constexpr int deltoid_middle = 1, brachialis = 9;
  REQUIRE(with_all_tendons[brachialis] > 6);
  distribution.fix(brachialis, 0);
  const VectorXd without_brachialis = distribution.distribute(arm.model.jacobian(), torque);
  CHECK(without_brachialis[brachialis] == 0);
  CHECK(distribution.missing().norm() < 1e-5);
  distribution.fix(brachialis, -1);
  CHECK((distribution.distribute(arm.model.jacobian(), torque) - with_all_tendons).norm() < 1e-6);
  distribution.fix(deltoid_middle, 0);
  distribution.distribute(arm.model.jacobian(), torque);
  CHECK(distribution.missing().norm() > 0.1);
}

TEST_CASE(
    "with the objective smooth, tensions are nearer to the previous tensions than without it") {
  Arm arm;
  auto smooth = arm.distribution(sim::TensionObjective::smooth),
       independent = arm.distribution(sim::TensionObjective::least_tension);
  const VectorXd torque = arm.gravity_Nm();
  const VectorXd first = smooth.distribute(arm.model.jacobian(), 3 * torque);
  const VectorXd second = smooth.distribute(arm.model.jacobian(), torque);
  independent.distribute(arm.model.jacobian(), 3 * torque);
  const VectorXd independent_second = independent.distribute(arm.model.jacobian(), torque);
  CHECK((second - first).norm() < (independent_second - first).norm());
}

TEST_CASE("a least tension above max_tension_N is rejected with the actuator's name") {
  Arm arm;
  CHECK_THROWS_WITH(arm.distribution(sim::TensionObjective::smooth, 300),
                    Catch::Contains("deltoid_anterior") && Catch::Contains("300"));
  CHECK_THROWS_AS(arm.distribution(sim::TensionObjective::smooth, -1), std::invalid_argument);
}

#include "sim/control/tension_share.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "sim/model/actuator/musculoskeletal.hpp"
#include "tests/sim/rigs.hpp"

namespace {

using Eigen::VectorXd;

struct Arm {
  erp::Robot robot = erp::read_robot(rigs::config("arm/robot.xml"));
  sim::Musculoskeletal model{robot};
  sim::TensionShare share(sim::TensionObjective objective, double least_N = 5) const {
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
    auto share = arm.share(objective);
    const VectorXd torque = arm.gravity_Nm();
    const VectorXd f = share.share(arm.model.jacobian(), torque);
    CHECK((arm.model.jacobian().transpose() * f + torque).norm() < 1e-5 * torque.norm() + 1e-6);
    CHECK(share.missing().norm() < 1e-5);
    CHECK(f.minCoeff() >= 5);
    CHECK(f.maxCoeff() <= 300);
  }
}

TEST_CASE("each objective has the smallest value of its own cost") {
  Arm arm;
  const VectorXd torque = arm.gravity_Nm();
  const auto& l = arm.model.jacobian();
  const VectorXd tension = arm.share(sim::TensionObjective::least_tension).share(l, torque);
  const VectorXd energy = arm.share(sim::TensionObjective::least_energy).share(l, torque);
  CHECK(energy.squaredNorm() == Approx(tension.squaredNorm()).epsilon(0.2));
  CHECK(copper_W(arm.robot, energy) <= copper_W(arm.robot, tension) + 1e-9);
  CHECK((tension.array() - 5).matrix().norm() <= (energy.array() - 5).matrix().norm() + 1e-9);
}

TEST_CASE("for an infeasible torque the error is minimal") {
  Arm arm;
  auto share = arm.share(sim::TensionObjective::least_tension);
  const auto& l = arm.model.jacobian();
  const VectorXd torque = 40 * arm.gravity_Nm();
  const VectorXd f = share.share(l, torque);
  const double missed = share.missing().norm();
  CHECK(missed > 1);
  CHECK((share.missing() - l.transpose() * f - torque).norm() < 1e-9);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> anywhere(5, 300), near(-1, 1);
  for (int k = 0; k < 2000; ++k) {
    const VectorXd other =
        k % 2 ? VectorXd::NullaryExpr(11, [&] { return anywhere(random); })
              : VectorXd((f + VectorXd::NullaryExpr(11, [&] { return near(random); }))
                             .cwiseMax(5)
                             .cwiseMin(300));
    REQUIRE((l.transpose() * other + torque).norm() >= missed - 1e-6);
  }
}

TEST_CASE("the other tendons compensate a lost tendon as far as possible") {
  Arm arm;
  auto share = arm.share(sim::TensionObjective::least_tension);
  const VectorXd torque = 2 * arm.gravity_Nm();
  const VectorXd all = share.share(arm.model.jacobian(), torque);
  constexpr int deltoid_middle = 1, brachialis = 9;
  REQUIRE(all[brachialis] > 6);
  share.fix(brachialis, 0);
  const VectorXd without = share.share(arm.model.jacobian(), torque);
  CHECK(without[brachialis] == 0);
  CHECK(share.missing().norm() < 1e-5);
  share.fix(brachialis, -1);
  CHECK((share.share(arm.model.jacobian(), torque) - all).norm() < 1e-6);
  share.fix(deltoid_middle, 0);
  share.share(arm.model.jacobian(), torque);
  CHECK(share.missing().norm() > 0.1);
}

TEST_CASE("with the objective smooth, tensions stay near the previous ones") {
  Arm arm;
  auto smooth = arm.share(sim::TensionObjective::smooth),
       independent = arm.share(sim::TensionObjective::least_tension);
  const VectorXd torque = arm.gravity_Nm();
  const VectorXd raised = smooth.share(arm.model.jacobian(), 3 * torque);
  const VectorXd back = smooth.share(arm.model.jacobian(), torque);
  independent.share(arm.model.jacobian(), 3 * torque);
  const VectorXd fresh = independent.share(arm.model.jacobian(), torque);
  CHECK((back - raised).norm() < (fresh - raised).norm());
}

TEST_CASE("a least tension above max_tension_N is rejected with the actuator's name") {
  Arm arm;
  CHECK_THROWS_WITH(arm.share(sim::TensionObjective::smooth, 300),
                    Catch::Contains("deltoid_anterior") && Catch::Contains("300"));
  CHECK_THROWS_AS(arm.share(sim::TensionObjective::smooth, -1), std::invalid_argument);
}

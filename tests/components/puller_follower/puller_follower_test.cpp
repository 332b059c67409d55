#include "components/puller_follower/puller_follower.hpp"

#include <catch2/catch.hpp>

#include "sim/model/actuator/motor.hpp"
#include "tests/components/joint_bench.hpp"

using namespace control;

namespace {

const erp::Robot& rig() {
  static const erp::Robot robot = erp::read_robot(ERP_SOURCE_DIR "/configs/hinge_rig/robot.xml");
  return robot;
}

}  // namespace

TEST_CASE("the puller applies the torque, the follower keeps the reference tension") {
  const Pair pair{{0.02, 0.04}};
  for (const double torque : {-1.0, -0.3, 0.0, 0.2, 2.0}) {
    const auto f = pair.tensions_N(torque, 5);
    CHECK(f[0] * 0.02 - f[1] * 0.04 == Approx(torque).margin(1e-12));
    CHECK(std::min(f[0], f[1]) == Approx(5));
  }
}

TEST_CASE("the reference tension is low while one muscle pulls, and high at and before a change") {
  const ReferenceTension reference{4, 15, 0.2, 0.1};
  CHECK(reference.of(1, 0) == 4);
  CHECK(reference.of(-1, 0) == 4);
  CHECK(reference.of(0, 0) == 15);
  CHECK(reference.of(0.5, -6) == 15);  // the roles change within 0.1 s
  CHECK(reference.of(0.5, 6) == 4);
  const double between = reference.of(0.1, 0);
  CHECK(between > 4);
  CHECK(between < 15);
}

TEST_CASE("the voltage increases with the tension error") {
  const erp::Actuator& flexor = rig().actuators[0];
  const TensionLinearisation law({rig().motor_of(flexor), flexor.spindle.radius_m},
                                 sim::Spring::of(flexor.tendon), 60);
  const double rest_V = law.voltage_V({10, 0, 0, 0}, {10, 0, 0});
  CHECK(law.voltage_V({10, 0, 0, 0}, {12, 0, 0}) > rest_V);
  CHECK(law.voltage_V({10, 0, 0, 0}, {14, 0, 0}) > law.voltage_V({10, 0, 0, 0}, {12, 0, 0}));
  CHECK(law.voltage_V({10, 0, 0, 0}, {8, 0, 0}) < rest_V);
  // A lengthening path stretches the tendon: the line is paid out.
  CHECK(law.voltage_V({10, 0, 0.01, 0}, {10, 0, 0}) < rest_V);
}

TEST_CASE("the inverse motor model gives the voltage for a desired speed") {
  const erp::Actuator& flexor = rig().actuators[0];
  const auto& type = rig().motor_of(flexor);
  const sim::Motor motor(type, flexor.spindle.radius_m);
  const sim::MotorInverse inverse(type, flexor.spindle.radius_m);
  for (const double speed : {-4.0, -1.0, 1.0, 4.0})
    for (const double tension : {5.0, 60.0}) {
      sim::MotorState state{inverse.current_A(tension, speed, 0), speed, 0};
      const double voltage = inverse.voltage_V(tension, speed, 0);
      for (int k = 0; k < 200; ++k) state = sim::step(motor, state, voltage, tension, 0.001);
      INFO(speed << " rad/s, " << tension << " N");
      CHECK(state.speed_rad_per_s == Approx(speed).epsilon(1e-6));
    }
}

TEST_CASE("a robot with ball joints or without two antagonists is refused, with a remedy") {
  const erp::Robot arm = erp::read_robot(ERP_SOURCE_DIR "/configs/arm/robot.xml");
  CHECK_THROWS_WITH(PullerFollower({}, arm), Catch::Contains("\"shoulder\" is not a hinge"));
  erp::Robot one_muscle = rig();
  one_muscle.actuators.pop_back();
  CHECK_THROWS_WITH(PullerFollower({}, one_muscle),
                    Catch::Contains("two antagonists") && Catch::Contains("computed_force"));
  PullerFollower::Params params;
  params.drives.high_N = 1;
  CHECK_THROWS_WITH(PullerFollower(params, rig()), Catch::Contains("high_N"));
}

TEST_CASE("each law gives the gravity torque without error and more torque for a positive error") {
  const erp::Robot robot = erp::read_robot(ERP_SOURCE_DIR "/configs/seven_dof/robot.xml");
  sim::Musculoskeletal model(robot);
  const int n = model.coordinates();
  Dynamics dynamics(n);
  dynamics.update(model.skeleton());
  for (const Law kind : {Law::linearised, Law::loop_shaping, Law::pd}) {
    INFO(int(kind));
    const auto law = law_of(kind, {}, model);
    JointErrors errors(n);
    law->begin(dynamics.gravity, dynamics);
    CHECK((law->torque_Nm(errors, dynamics, 0.002) - dynamics.gravity).norm() < 1e-9);
    errors.error_rad[3] = 0.1;
    Eigen::VectorXd torque = law->torque_Nm(errors, dynamics, 0.002);
    for (int k = 0; k < 20; ++k) torque = law->torque_Nm(errors, dynamics, 0.002);
    CHECK(torque[3] > dynamics.gravity[3] + 0.01);
  }
}

TEST_CASE("a law with an integral state starts at the acting torque and keeps it without error") {
  const erp::Robot robot = erp::read_robot(ERP_SOURCE_DIR "/configs/seven_dof/robot.xml");
  sim::Musculoskeletal model(robot);
  Dynamics dynamics(model.coordinates());
  dynamics.update(model.skeleton());
  const JointErrors zero_errors(model.coordinates());
  Eigen::VectorXd acting_Nm = dynamics.gravity;
  acting_Nm[3] += 0.2;
  for (const Law kind : {Law::linearised, Law::loop_shaping}) {
    INFO(int(kind));
    const auto law = law_of(kind, {}, model);
    law->begin(acting_Nm, dynamics);
    for (int k = 0; k < 100; ++k)
      CHECK((law->torque_Nm(zero_errors, dynamics, 0.002) - acting_Nm).norm() < 1e-9);
  }
}

TEST_CASE("a constant unmodelled acceleration is estimated within 1 %") {
  DisturbanceObserver load(1);
  Eigen::VectorXd speed = Eigen::VectorXd::Zero(1), model = speed;
  load.begin(speed, model);
  model[0] = 3;  // the model predicts 3, the joint accelerates at −2
  for (int k = 0; k < 5000; ++k) speed[0] -= 0.002 * 2, load.update(speed, model, 0.002);
  CHECK(load.acceleration_rad_per_s2()[0] == Approx(-5).epsilon(0.01));
  load.begin(speed, model);
  CHECK(load.acceleration_rad_per_s2()[0] == -3);
}

TEST_CASE("a joint whose motors saturate is braked until it is at rest, then controlled again") {
  JointBench bench("hinge_rig/robot.xml");
  PullerFollower control({}, bench.robot);
  auto& joint = bench.state.message.joints._buffer[0];
  const auto mode_after = [&](double error_rad, double speed_rad_per_s, int steps) {
    bench.target.message.joints._buffer[0].position[0] = joint.position[0] + error_rad;
    joint.velocity_rad_per_s[0] = speed_rad_per_s;
    std::optional<erp::ActuatorCommand> command;
    for (int k = 0; k < steps; ++k) command = bench.step(control);
    return erp::Mode(command->actuators._buffer[0].mode);
  };
  CHECK(mode_after(0, 0, 500) == erp::Mode::voltage);
  CHECK(mode_after(2, 0.5, 100) == erp::Mode::voltage);
  CHECK(mode_after(2, 0.5, 400) == erp::Mode::length);
  const double held_line_m = bench.references(bench.step(control))[0];
  CHECK(mode_after(2, -0.5, 400) == erp::Mode::length);
  CHECK(bench.references(bench.step(control))[0] <
        held_line_m);  // the line was paid out before and is wound up now
  CHECK(mode_after(0, 0, 40) == erp::Mode::length);
  CHECK(mode_after(0, 0, 20) == erp::Mode::voltage);
}

TEST_CASE("a loop shape without solution is refused") {
  sim::Musculoskeletal model(rig());
  LawParams params;
  params.shape.delay_s = 1e-12;  // a pole at 2e12 /s is numerically infeasible
  params.shape.crossover_Hz = 1e9;
  CHECK_THROWS_AS(law_of(Law::loop_shaping, params, model), std::invalid_argument);
}

TEST_CASE("without a target, or with an unmeasured tendon, there is no command") {
  PullerFollower control({}, rig());
  CHECK_FALSE(control.step({}, 0.002, {}, {}));
}

TEST_CASE("control starts at the joint's position, and restarts there after missing frames") {
  JointBench bench("hinge_rig/robot.xml");
  PullerFollower control({}, bench.robot);
  const auto first = bench.references(bench.step(control));
  bench.target.message.joints._buffer[0].position[0] += 0.3;
  Eigen::VectorXd tracking = first;
  for (int k = 0; k < 100; ++k) tracking = bench.references(bench.step(control));
  CHECK(tracking[0] > first[0] + 1);
  CHECK((bench.references(bench.step(control, 0.3)) - first).norm() < 0.2);
}

TEST_CASE(
    "while a tendon is slack the joint is held; afterwards it is guided from the held angle") {
  JointBench moving("hinge_rig/robot.xml"), resting("hinge_rig/robot.xml");
  PullerFollower moving_control({}, moving.robot), resting_control({}, resting.robot);
  moving.target.message.joints._buffer[0].position[0] += 0.3;
  const auto flexor_difference_V = [&](double extensor_N, int steps) {
    Eigen::VectorXd difference;
    for (JointBench* bench : {&moving, &resting})
      bench->frame.actuators._buffer[1].tension_N = extensor_N;
    for (int k = 0; k < steps; ++k)
      difference = moving.references(moving.step(moving_control)) -
                   resting.references(resting.step(resting_control));
    return difference[0];
  };
  CHECK(flexor_difference_V(5, 100) > 1);
  CHECK(flexor_difference_V(0, 100) == Approx(0).margin(0.1));
  CHECK(flexor_difference_V(5, 1) == Approx(0).margin(0.1));
  CHECK(flexor_difference_V(5, 100) > 1);
}

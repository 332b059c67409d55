#include "components/computed_force/computed_force.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "sim/model/actuator/tendon.hpp"
#include "tests/components/joint_bench.hpp"

using control::ComputedForce;

namespace {

/// A bench with the arm.
struct Bench : JointBench {
  Bench() : JointBench("arm/robot.xml") {}
};

/// Parameters without compensation of the force laws' lag.
ComputedForce::Params without_lag_compensation() {
  ComputedForce::Params params;
  params.lag_compensation = 0;
  return params;
}

}  // namespace

TEST_CASE("at the target and at rest the tensions give the gravity torque") {
  Bench bench;
  ComputedForce control(without_lag_compensation(), bench.robot);
  CHECK((bench.torque_of(bench.step(control)) - bench.gravity_Nm()).norm() < 1e-4);
}

TEST_CASE("an elbow error of 0.1 rad commands an acceleration of k_p times the error") {
  Bench bench;
  ComputedForce control(without_lag_compensation(), bench.robot);
  bench.target.message.joints._buffer[1].position[0] += 0.1;
  Eigen::MatrixXd inertia;
  bench.model.skeleton().inertia(inertia);
  Eigen::VectorXd acceleration = Eigen::VectorXd::Zero(4);
  acceleration[3] = 100 * 0.1;
  const Eigen::VectorXd torque = bench.gravity_Nm() + inertia * acceleration;
  CHECK((bench.torque_of(bench.step(control)) - torque).norm() < 1e-4);
}

TEST_CASE("a ball joint error of 3.1 rad gives finite commands within limits") {
  Bench bench;
  ComputedForce control(without_lag_compensation(), bench.robot);
  const Eigen::AngleAxisd rotation(3.1, Eigen::Vector3d(1, 1, 0).normalized());
  const Eigen::Quaterniond q(rotation);
  const double quaternion_wxyz[] = {q.w(), q.x(), q.y(), q.z()};
  std::ranges::copy(quaternion_wxyz, bench.target.message.joints._buffer[0].position);
  const auto command = bench.step(control);
  REQUIRE(command);
  for (const auto& reference : erp::samples(command->actuators)) {
    CHECK(std::isfinite(reference.reference));
    CHECK(reference.reference <= 300);
  }
}

TEST_CASE("stale, invalid or incomplete joints or targets give no command") {
  Bench bench;
  ComputedForce control({}, bench.robot);
  CHECK(bench.step(control));
  bench.state.age_s = 0.06;
  CHECK_FALSE(bench.step(control));
  bench.state.age_s = 0;
  bench.target.age_s = 0.06;
  CHECK_FALSE(bench.step(control));
  bench.target.age_s = 0;
  bench.state.message.joints._buffer[1].position[0] = std::nan("");
  CHECK_FALSE(bench.step(control));
  bench.state.message.joints._buffer[1].position[0] = 0.3;
  CHECK(bench.step(control));
  bench.target.message.joints._length = 1;
  CHECK_FALSE(bench.step(control));
}

TEST_CASE("only the joint_state of the named source is used") {
  Bench bench;
  ComputedForce::Params params;
  params.source = "pose_estimator";
  const ComputedForce control(params, bench.robot);
  erp::assign(bench.state.message.source, "sim");
  CHECK_FALSE(control.accepts(bench.state.message));
  erp::assign(bench.state.message.source, "pose_estimator");
  CHECK(control.accepts(bench.state.message));
}

TEST_CASE("a muscle whose ECU has tripped keeps its tension, and the others compensate") {
  Bench bench;
  ComputedForce control(without_lag_compensation(), bench.robot);
  bench.target.message.joints._buffer[1].position[0] += 0.3;
  const Eigen::VectorXd desired = bench.torque_of(bench.step(control));
  constexpr int brachialis = 9;
  auto& sample = bench.frame.actuators._buffer[brachialis];
  sample.ecu_state = static_cast<std::uint8_t>(erp::EcuState::fault);
  sample.tension_N = 2;
  auto command = bench.step(control);
  REQUIRE(command);
  CHECK(command->actuators._buffer[brachialis].reference == Approx(2));
  CHECK((bench.torque_of(command) - desired).norm() < 1e-3);
}

namespace {

/// A random posture near the start: hinges by up to 0.6 rad, ball joints by 0.4 rad per axis.
std::vector<sim::JointReading> random_posture(const erp::Robot& robot, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<sim::JointReading> joints;
  for (const erp::Joint& joint : robot.joints()) {
    joints.push_back(sim::initial_reading(joint));
    const double range_rad = joint.type == erp::JointType::revolute ? 0.6 : 0.4;
    joints.back().position =
        sim::displaced(joint.type, joints.back().position,
                  std::array{range_rad * (1 + uniform(random)) / 2, range_rad * uniform(random),
                             range_rad * uniform(random)});
  }
  return joints;
}

/// A sensor frame of a robot in a posture, with all tendons at 10 N.
erp::SensorFrame measured(const erp::Robot& robot, const sim::Musculoskeletal& model) {
  erp::SensorFrame frame;
  for (std::size_t a = 0; a < robot.actuators.size(); ++a) {
    const auto law =
        sim::TendonLaw::at_rest(robot.actuators[a].tendon, robot.actuators[a].spindle, 0);
    erp::ActuatorSample sample{};
    erp::assign(sample.name, robot.actuators[a].name);
    sample.valid = erp::valid::all, sample.tension_N = 10;
    const double length_m = model.length_m()[static_cast<Eigen::Index>(a)];
    sample.shaft_rad = (law.length_m(10, 0) - length_m) / law.radius_m;
    erp::append(frame.actuators, sample);
  }
  return frame;
}

}  // namespace

TEST_CASE("online learning halves the Jacobian error of a wrong robot.xml") {
  const erp::Robot real = erp::read_robot(ERP_SOURCE_DIR "/configs/arm/robot.xml");
  erp::Robot model_robot = real;
  for (auto& actuator : model_robot.actuators)
    for (auto& element : actuator.tendon.path)
      if (auto* attach = std::get_if<erp::Attach>(&element); attach && attach->body == "upper_arm")
        attach->at_m[0] += 0.008;
  sim::Musculoskeletal truth(real), model(model_robot);
  const auto source =
      control::jacobian_source(control::JacobianKind::on_line, "", model_robot, model);
  std::mt19937 random(7);
  const auto rms_error_m = [&](int postures, bool learn) {
    double square_sum = 0;
    for (int k = 0; k < postures; ++k) {
      const auto joints = random_posture(real, random);
      truth.place(joints), model.place(joints);
      if (learn) source->update(joints, measured(real, truth));
      square_sum += (source->at(joints) - truth.jacobian()).squaredNorm();
    }
    return std::sqrt(square_sum / postures);
  };
  const double before = rms_error_m(100, false);
  rms_error_m(3000, true);
  const double after = rms_error_m(100, false);
  INFO(1e3 * before << " mm before, " << 1e3 * after << " mm after");
  CHECK(before > 0.003);
  CHECK(after < before / 2);
}

TEST_CASE("a frame with a slack or unmeasured tendon does not change the Jacobian") {
  const erp::Robot robot = erp::read_robot(ERP_SOURCE_DIR "/configs/arm/robot.xml");
  sim::Musculoskeletal model(robot);
  const auto source = control::jacobian_source(control::JacobianKind::on_line, "", robot, model);
  std::mt19937 random(8);
  const auto joints = random_posture(robot, random);
  model.place(joints);
  for (const bool slack : {true, false}) {
    auto frame = measured(robot, model);
    auto& first = frame.actuators._buffer[0];
    if (slack) first.tension_N = 0;
    else first.valid = 0;
    for (auto& sample : erp::samples(frame.actuators)) sample.shaft_rad += 1;
    source->update(joints, frame);
    CHECK((source->at(joints) - model.jacobian()).norm() == 0);
  }
}

TEST_CASE("a learned Jacobian without its file is refused, with the command that writes it") {
  const erp::Robot robot = erp::read_robot(ERP_SOURCE_DIR "/configs/arm/robot.xml");
  ComputedForce::Params params;
  params.jacobian = control::JacobianKind::network;
  CHECK_THROWS_WITH(ComputedForce(params, robot), Catch::Contains("erp model muscles"));
}

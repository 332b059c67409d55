#include <catch2/catch.hpp>
#include <random>

#include "sim/control/pose_plan.hpp"
#include "sim/learning/muscle_networks/babble.hpp"
#include "sim/learning/muscle_networks/learned_lengths.hpp"
#include "sim/learning/muscle_networks/length_learner.hpp"
#include "sim/learning/muscle_networks/torque_error.hpp"
#include "sim/learning/muscle_networks/workspace.hpp"
#include "sim/model/actuator/motor.hpp"
#include "sim/model/skeleton/joint_path.hpp"

using namespace sim::muscle_networks;
using Joints = std::vector<sim::JointReading>;

namespace {

erp::Robot arm() { return erp::read_robot(ERP_SOURCE_DIR "/configs/arm/robot.xml"); }

/// A random posture of the arm: elbow over its range, shoulder turned by up to half a radian per
/// axis.
Joints random_posture(const erp::Robot& robot, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  Joints joints;
  for (const erp::Joint& joint : robot.joints()) {
    joints.push_back(sim::initial_reading(joint));
    auto& position = joints.back().position;
    if (joint.type == erp::JointType::spherical)
      position =
          sim::displaced(joint.type, position,
                         std::array{0.5 * unit(random), 0.5 * unit(random), 0.5 * unit(random)});
    else
      position[0] =
          0.5 * (joint.min_rad + joint.max_rad + unit(random) * (joint.max_rad - joint.min_rad));
  }
  return joints;
}

LengthSamples samples(const erp::Robot& robot, int count, unsigned seed) {
  std::mt19937 random(seed);
  sim::Musculoskeletal model(robot);
  LengthSamples all;
  all.length_m.resize(model.length_m().size(), count);
  for (int k = 0; k < count; ++k) {
    all.joints.push_back(random_posture(robot, random));
    model.place(all.joints.back());
    all.length_m.col(k) = model.length_m();
  }
  return all;
}

}  // namespace

TEST_CASE("derivatives of posture inputs equal difference quotients, also for ball joints") {
  const erp::Robot robot = arm();
  const sim::Musculoskeletal model(robot);
  const PostureInputs inputs(model.tree().joints, model.skeleton());
  std::mt19937 random(1);
  Eigen::VectorXd x, forward, backward;
  Eigen::MatrixXd slopes;
  constexpr double step = 1e-5;
  for (int k = 0; k < 20; ++k) {
    const Joints joints = random_posture(robot, random);
    inputs.read(joints, x), inputs.slopes(x, slopes);
    for (std::size_t j = 0; j < joints.size(); ++j)
      for (int d = 0; d < sim::coordinates_of(joints[j].type); ++d) {
        const auto displaced_by = [&](double angle_rad) {
          Joints other = joints;
          std::array<double, 3> u{};
          u[std::size_t(d)] = angle_rad;
          other[j].position = sim::displaced(joints[j].type, joints[j].position, u);
          return other;
        };
        inputs.read(displaced_by(step), forward), inputs.read(displaced_by(-step), backward);
        const int coordinate = model.skeleton().first_of(int(j)) + d;
        CHECK(((forward - backward) / (2 * step) - slopes.col(coordinate)).norm() < 1e-8);
      }
  }
}

TEST_CASE("a perceptron's gradient equals its difference quotient, and a fit recovers its data") {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> unit(-1, 1);
  Perceptron source = Perceptron::drawn(3, 4, 5);
  source.output << 1, -0.5, 0.3, 0.8, 0.2;
  const Eigen::MatrixXd x = Eigen::MatrixXd::NullaryExpr(3, 400, [&] { return unit(random); });
  Eigen::VectorXd y(400), slope;
  for (int k = 0; k < 400; ++k) y[k] = source.value(x.col(k));
  Perceptron net = Perceptron::drawn(3, 6, 9);
  CHECK(fit(net, x, y, {.max_steps = 300, .decay = 1e-12}) < 1e-3);
  for (int k = 0; k < 10; ++k) {
    Eigen::VectorXd at = x.col(k), forward = at;
    net.gradient(at, slope);
    forward[1] += 1e-6;
    CHECK((net.value(forward) - net.value(at)) / 1e-6 == Approx(slope[1]).margin(1e-4));
  }
}

TEST_CASE("networks trained on 1500 samples give torques within 6 %") {
  const erp::Robot robot = arm();
  const LengthSamples training = samples(robot, 1500, 3), check = samples(robot, 100, 4);
  LearnOptions options;
  options.units = 8, options.fit.max_steps = 60;
  const LearnedMuscles learned = learn(robot, training, options);
  LearnedLengths lengths(robot, learned);
  const auto slope = torque_error(
      robot, check.joints, [&](auto q) -> auto& { return lengths.jacobian(q); });
  const auto quotient = torque_error(
      robot, check.joints, [&](auto q) -> auto& { return lengths.jacobian_by_difference(q); });
  INFO(100 * slope.share << " %");
  CHECK(slope.share < 0.06);
  CHECK(quotient.share == Approx(slope.share).margin(0.002));
}

TEST_CASE("online learning reduces the torque error below 10 % in 3000 samples") {
  const erp::Robot robot = arm();
  const LengthSamples training = samples(robot, 3000, 5), check = samples(robot, 100, 6);
  const sim::Musculoskeletal model(robot);
  LengthLearner learner({model.tree().joints, model.skeleton()}, training.length_m.rows(),
                        {.weight_m = 0.01, .noise_m = 1e-5});  // no base, no noise
  std::vector<double> errors;
  for (int k = 0; k < 3000; ++k) {
    learner.add_sample(training.joints[std::size_t(k)], training.length_m.col(k));
    if (k == 200 || k == 2999)
      errors.push_back(
          torque_error(
              robot, check.joints, [&](auto q) -> auto& { return learner.jacobian(q); })
              .share);
  }
  INFO(100 * errors[0] << " %, " << 100 * errors[1] << " %");
  CHECK(errors[1] < 0.1);
  CHECK(errors[1] < errors[0] / 2);
  CHECK_FALSE(learner.add_sample(training.joints.back(),
                                 training.length_m.col(2999)));  // same posture as before
}

TEST_CASE("networks of another robot and too few samples are rejected") {
  const erp::Robot robot = arm();
  CHECK_THROWS_WITH(learn(robot, samples(robot, 20, 1)), Catch::Contains("too few"));
  LearnedMuscles other;
  other.robot = "leg";
  CHECK_THROWS_WITH(LearnedLengths(robot, other), Catch::Contains("leg"));
}

TEST_CASE("babbling starts at the pretensions and keeps every tendon within its bounds") {
  const erp::Robot robot = arm();
  const auto table = babble(robot, {.duration_s = 20, .seed = 3});
  for (const erp::Actuator& actuator : robot.actuators) {
    const auto* column = table.find(actuator.name + ".reference");
    REQUIRE(column);
    CHECK(column->values.front() ==
          Approx(std::max(4.0, actuator.tendon.pretension_N)).margin(0.1));
    for (const double f : column->values) CHECK((f >= 4 && f <= actuator.max_tension_N / 2));
  }
  CHECK(table.rows() > 25);
}

TEST_CASE("every posture of a workspace can be held by the muscles") {
  erp::Robot robot = arm();
  Workspace workspace(robot, {.seed = 5});
  sim::PoseHolder holder(robot);
  for (int k = 0; k < 50; ++k) {
    const auto holding = holder.hold(workspace.draw());
    CHECK(holding.unbalanced_Nm < 0.05);
    for (std::size_t a = 0; a < robot.actuators.size(); ++a)
      CHECK(holding.tension_N[a] <= 0.5 * robot.actuators[a].max_tension_N);
  }
  for (auto& actuator : robot.actuators) actuator.max_tension_N = 12;
  Workspace none(robot, {.seed = 5});
  CHECK_THROWS_WITH(none.draw(), Catch::Contains("hold none"));
}

TEST_CASE("joint motion covers the workspace within the motors' speed") {
  const erp::Robot robot = arm();
  const auto poses = sim::poses_of(joint_motion(robot, {.duration_s = 60}), robot);
  const sim::JointPath path(robot.joints(), poses, sim::Via::through);
  CHECK(path.end_s() > 60);
  CHECK(poses.size() > 15);
  sim::Musculoskeletal model(robot);
  std::vector<sim::JointMotion> at;
  double highest_fraction = 0;
  for (double t_s = 0; t_s < path.end_s(); t_s += 0.02) {
    path.at(t_s, at);
    Joints posture;
    Eigen::VectorXd speed(model.coordinates());
    for (std::size_t j = 0; j < at.size(); ++j) {
      posture.push_back(at[j].now);
      for (int d = 0; d < sim::coordinates_of(at[j].now.type); ++d)
        speed[model.skeleton().first_of(int(j)) + d] = at[j].now.velocity_rad_per_s[std::size_t(d)];
    }
    CHECK((at[1].now.position[0] > -0.05 && at[1].now.position[0] < 2.4));
    model.place(posture);
    const Eigen::VectorXd line = model.jacobian() * speed;
    for (Eigen::Index a = 0; a < line.size(); ++a) {
      const auto& actuator = robot.actuators[std::size_t(a)];
      highest_fraction =
          std::max(highest_fraction,
                   std::abs(line[a]) / sim::top_line_speed_m_per_s(robot.motor_of(actuator),
                                                                   actuator.spindle.radius_m));
    }
  }
  INFO(highest_fraction);
  CHECK(highest_fraction < 1);
}

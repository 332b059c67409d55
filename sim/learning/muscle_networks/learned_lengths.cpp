#include "sim/learning/muscle_networks/learned_lengths.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/model/actuator/musculoskeletal.hpp"
#include "sim/model/skeleton/joint_path.hpp"

namespace sim::muscle_networks {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

PostureInputs inputs_of(const erp::Robot& robot) {
  const Musculoskeletal model(robot);
  return {model.tree().joints, model.skeleton()};
}

MatrixXd inputs_at(const PostureInputs& inputs, const LengthSamples& samples) {
  MatrixXd x(inputs.size(), static_cast<Index>(samples.joints.size()));
  VectorXd input;
  for (std::size_t k = 0; k < samples.joints.size(); ++k) {
    inputs.read(samples.joints[k], input);
    x.col(static_cast<Index>(k)) = input;
  }
  return x;
}

std::vector<double> numbers(const auto& matrix) {
  return {matrix.data(), matrix.data() + matrix.size()};
}

}  // namespace

LearnedMuscles learn(const erp::Robot& robot, const LengthSamples& samples,
                     const LearnOptions& options) {
  constexpr Index samples_per_weight = 3;  // chosen
  const PostureInputs inputs = inputs_of(robot);
  const Index weights = options.units * (inputs.size() + 2) + 1;
  if (static_cast<Index>(samples.joints.size()) < samples_per_weight * weights)
    throw std::invalid_argument(std::to_string(samples.joints.size()) +
                                " samples are too few for networks with " +
                                std::to_string(weights) + " weights; give longer recordings");
  const MatrixXd x = inputs_at(inputs, samples);
  LearnedMuscles learned;
  learned.robot = robot.name;
  for (std::size_t a = 0; a < robot.actuators.size(); ++a) {
    const VectorXd l = samples.length_m.row(static_cast<Index>(a)).transpose();
    LearnedMuscle muscle;
    muscle.name = robot.actuators[a].name, muscle.units = options.units;
    muscle.centre_m = l.mean();
    muscle.spread_m = std::sqrt((l.array() - l.mean()).square().mean());
    if (!(muscle.spread_m > 0))
      throw std::invalid_argument("muscle \"" + muscle.name +
                                  "\" never changed its length; record a motion that moves it");
    Perceptron net = Perceptron::drawn(x.rows(), options.units, options.seed + a);
    muscle.left_m =
        muscle.spread_m * fit(net, x, (l.array() - muscle.centre_m) / muscle.spread_m, options.fit);
    muscle.hidden = numbers(net.hidden), muscle.output = numbers(net.output);
    learned.list.push_back(std::move(muscle));
    options.progress(a + 1, robot.actuators.size());
  }
  return learned;
}

LearnedLengths::LearnedLengths(const erp::Robot& robot, const LearnedMuscles& learned)
    : inputs_(inputs_of(robot)) {
  for (const erp::Actuator& actuator : robot.actuators) {
    const auto muscle = std::ranges::find(learned.list, actuator.name, &LearnedMuscle::name);
    const Index columns = inputs_.size() + 1;
    if (learned.robot != robot.name || muscle == learned.list.end() ||
        std::ssize(muscle->hidden) != muscle->units * columns ||
        std::ssize(muscle->output) != muscle->units + 1)
      throw std::invalid_argument(learned.place.file + ": was learned on robot \"" + learned.robot +
                                  "\" or lacks muscle \"" + actuator.name + "\" of \"" +
                                  robot.name + "\"; run erp model muscles on this robot");
    muscles_.push_back({{Eigen::Map<const MatrixXd>(muscle->hidden.data(), muscle->units, columns),
                         Eigen::Map<const VectorXd>(muscle->output.data(), muscle->units + 1)},
                        muscle->centre_m,
                        muscle->spread_m});
  }
  const Musculoskeletal model(robot);
  joint_of_coordinate_.resize(static_cast<std::size_t>(inputs_.coordinates()));
  for (std::size_t j = 0; j < model.tree().joints.size(); ++j)
    if (const int first = model.skeleton().first_of(static_cast<int>(j)); first >= 0)
      for (int d = 0; d < coordinates_of(model.tree().joints[j].type); ++d)
        joint_of_coordinate_[static_cast<std::size_t>(first + d)] = {j, d};
  varied_joints_.resize(model.tree().joints.size());
  const auto muscles = static_cast<Index>(muscles_.size());
  x_.resize(inputs_.size()), dy_dx_.resize(inputs_.size());
  length_m_.resize(muscles), forward_length_m_.resize(muscles);
  slopes_.resize(inputs_.size(), inputs_.coordinates());
  jacobian_.resize(muscles, inputs_.coordinates());
}

const VectorXd& LearnedLengths::length_m(std::span<const JointReading> joints) {
  inputs_.read(joints, x_);
  for (std::size_t a = 0; a < muscles_.size(); ++a)
    length_m_[static_cast<Index>(a)] =
        muscles_[a].centre_m + muscles_[a].spread_m * muscles_[a].net.value(x_);
  return length_m_;
}

const MatrixXd& LearnedLengths::jacobian(std::span<const JointReading> joints) {
  inputs_.read(joints, x_);
  inputs_.slopes(x_, slopes_);
  for (std::size_t a = 0; a < muscles_.size(); ++a) {
    muscles_[a].net.gradient(x_, dy_dx_);
    jacobian_.row(static_cast<Index>(a)).noalias() =
        muscles_[a].spread_m * dy_dx_.transpose() * slopes_;
  }
  return jacobian_;
}

const MatrixXd& LearnedLengths::jacobian_by_difference(std::span<const JointReading> joints,
                                                       double step_rad) {
  std::ranges::copy(joints, varied_joints_.begin());
  for (std::size_t c = 0; c < joint_of_coordinate_.size(); ++c) {
    const auto [joint, dof] = joint_of_coordinate_[c];
    std::array<double, 3> u{};
    const auto at = joints[joint].position;
    u[static_cast<std::size_t>(dof)] = step_rad;
    varied_joints_[joint].position = displaced(joints[joint].type, at, u);
    forward_length_m_ = length_m(varied_joints_);
    u[static_cast<std::size_t>(dof)] = -step_rad;
    varied_joints_[joint].position = displaced(joints[joint].type, at, u);
    jacobian_.col(static_cast<Index>(c)) =
        (forward_length_m_ - length_m(varied_joints_)) / (2 * step_rad);
    varied_joints_[joint].position = at;
  }
  return jacobian_;
}

}  // namespace sim::muscle_networks

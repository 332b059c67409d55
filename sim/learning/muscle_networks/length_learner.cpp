#include "sim/learning/muscle_networks/length_learner.hpp"

namespace sim::muscle_networks {
namespace {

/// P before the first sample. The constant is unknown, so its prior is wide.
Eigen::MatrixXd initial_p(const LengthLearner::Options& options) {
  constexpr double constant_m = 1;  // chosen: larger than every unknown constant
  Eigen::VectorXd expected_m = Eigen::VectorXd::Constant(options.units + 1, options.weight_m);
  expected_m[options.units] = constant_m;
  return (expected_m / options.noise_m).cwiseAbs2().asDiagonal();
}

}  // namespace

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

LengthLearner::LengthLearner(const PostureInputs& inputs, Index muscles, const Options& options)
    : inputs_(inputs),
      options_(options),
      weights_(Perceptron::drawn(inputs.size(), options.units, options.seed).hidden),
      p_(initial_p(options)),
      c_(MatrixXd::Zero(options.units + 1, muscles)),
      x_(VectorXd::Zero(inputs.size())),
      last_x_(VectorXd::Constant(inputs.size(), 1e9)),
      phi_(VectorXd::Zero(options.units + 1)),
      gain_(phi_),
      residual_m_(VectorXd::Zero(muscles)),
      slopes_(MatrixXd::Zero(inputs.size(), inputs.coordinates())),
      feature_slopes_(MatrixXd::Zero(options.units, inputs.coordinates())),
      jacobian_(MatrixXd::Zero(muscles, inputs.coordinates())) {}

void LengthLearner::compute_features(std::span<const JointReading> joints) {
  inputs_.read(joints, x_);
  const Index n = inputs_.size();
  phi_.head(options_.units).noalias() = weights_.leftCols(n) * x_;
  phi_.head(options_.units) = (phi_.head(options_.units) + weights_.col(n)).array().tanh();
  phi_[options_.units] = 1;
}

bool LengthLearner::add_sample(std::span<const JointReading> joints, const VectorXd& correction_m) {
  compute_features(joints);
  if ((x_ - last_x_).lpNorm<Eigen::Infinity>() < options_.move) return false;
  last_x_ = x_;
  gain_.noalias() = p_.selfadjointView<Eigen::Lower>() * phi_;
  const double scale = options_.forgetting + phi_.dot(gain_);
  residual_m_ = correction_m;
  residual_m_.noalias() -= c_.transpose() * phi_;
  c_.noalias() += gain_ * (residual_m_.transpose() / scale);
  p_.selfadjointView<Eigen::Lower>().rankUpdate(gain_, -1 / scale);
  if (options_.forgetting < 1) p_ /= options_.forgetting;
  ++samples_;
  return true;
}

const MatrixXd& LengthLearner::jacobian(std::span<const JointReading> joints) {
  compute_features(joints);
  inputs_.slopes(x_, slopes_);
  feature_slopes_.noalias() = weights_.leftCols(inputs_.size()) * slopes_;
  for (Index k = 0; k < options_.units; ++k) feature_slopes_.row(k) *= 1 - phi_[k] * phi_[k];
  jacobian_.noalias() = c_.topRows(options_.units).transpose() * feature_slopes_;
  return jacobian_;
}

}  // namespace sim::muscle_networks

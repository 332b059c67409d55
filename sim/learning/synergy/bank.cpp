#include "sim/learning/synergy/bank.hpp"

#include <Eigen/Cholesky>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace sim::synergy {

using Eigen::Index;
using Eigen::Vector3d;

namespace {

double distance_m(const MotorPlan& plan, const Vector3d& at_m) { return (plan.at_m - at_m).norm(); }

/// Distance of the fourth nearest plan.
double fourth_nearest_m(const std::vector<MotorPlan>& plans, const Vector3d& at_m) {
  std::vector<double> distances_m;
  for (const MotorPlan& plan : plans) distances_m.push_back(distance_m(plan, at_m));
  const auto k = std::min<std::size_t>(3, distances_m.size() - 1);
  std::ranges::nth_element(distances_m, distances_m.begin() + static_cast<std::ptrdiff_t>(k));
  return distances_m[k];
}

/// β_k.
std::vector<double> credits_of(const std::vector<MotorPlan>& plans, const Vector3d& target_m,
                               double basis_m) {
  std::vector<double> credits;
  double sum = 0;
  for (const MotorPlan& plan : plans) {
    const double relative_distance = distance_m(plan, target_m) / basis_m;
    sum += credits.emplace_back(plan.value * plan.value *
                                std::exp(-0.5 * relative_distance * relative_distance));
  }
  const double uniform =
      sum > 0 ? 0 : 1;  // all values are zero, or all plans far away: equal credits
  for (double& credit : credits)
    credit = (credit + uniform) / (sum + uniform * static_cast<double>(plans.size()));
  return credits;
}

/// γ_k.
std::vector<double> balanced_weights(const std::vector<double>& credits,
                                     const std::vector<MotorPlan>& plans, const Vector3d& target_m,
                                     double basis_m, double max_extrapolation_m) {
  constexpr double epsilon = 0.1;  // chosen
  Vector3d mean_m = Vector3d::Zero();
  for (std::size_t k = 0; k < plans.size(); ++k) mean_m += credits[k] * plans[k].at_m;
  Eigen::Matrix3d scatter = epsilon * basis_m * basis_m * Eigen::Matrix3d::Identity();
  for (std::size_t k = 0; k < plans.size(); ++k) {
    const Vector3d off_m = plans[k].at_m - mean_m;
    scatter += credits[k] * off_m * off_m.transpose();
  }
  const Vector3d to_target_m = target_m - mean_m;
  const double scale = std::min(1.0, max_extrapolation_m / std::max(to_target_m.norm(), 1e-9));
  const Vector3d correction = scatter.ldlt().solve(scale * to_target_m);
  std::vector<double> weights = credits;
  for (std::size_t k = 0; k < plans.size(); ++k)
    weights[k] *= 1 + correction.dot(plans[k].at_m - mean_m);
  return weights;
}

/// The less valuable of the two plans whose places are nearest to each other.
std::size_t least_valuable_neighbor(const std::vector<MotorPlan>& plans) {
  double smallest_m = HUGE_VAL;
  std::size_t less_valuable = 0;
  for (std::size_t a = 0; a < plans.size(); ++a)
    for (std::size_t b = a + 1; b < plans.size(); ++b)
      if (const double off_m = distance_m(plans[a], plans[b].at_m); off_m < smallest_m)
        smallest_m = off_m, less_valuable = plans[a].value < plans[b].value ? a : b;
  return less_valuable;
}

}  // namespace

Blend Bank::blend(const Vector3d& target_m) const {
  if (plans_.empty())
    throw std::invalid_argument(
        "a bank without plans cannot blend one; run erp learn synergy first");
  const double basis_m = std::max(options_.basis_m, fourth_nearest_m(plans_, target_m));
  Blend blend{.plan = {.weights_m = Eigen::VectorXd::Zero(plans_.front().weights_m.size()),
                       .signal = {0, 0},
                       .at_m = target_m,
                       .value = 0},
              .credits = credits_of(plans_, target_m, basis_m)};
  const auto weights =
      balanced_weights(blend.credits, plans_, target_m, basis_m, options_.max_extrapolation_m);
  for (std::size_t k = 0; k < plans_.size(); ++k) {
    blend.plan.weights_m += weights[k] * plans_[k].weights_m;
    blend.plan.signal.rise_s += blend.credits[k] * plans_[k].signal.rise_s;
    blend.plan.signal.overshoot += blend.credits[k] * plans_[k].signal.overshoot;
    blend.plan.value += blend.credits[k] * plans_[k].value;
  }
  return blend;
}

void Bank::credit(const std::vector<double>& credits, double reward) {
  for (std::size_t k = 0; k < credits.size(); ++k)
    plans_[k].value += options_.rate * credits[k] * (reward - plans_[k].value);
}

void Bank::add(MotorPlan plan) { plans_.push_back(std::move(plan)); }

void Bank::cut(std::size_t count) {
  while (plans_.size() > std::max<std::size_t>(1, count))
    plans_.erase(plans_.begin() + static_cast<std::ptrdiff_t>(least_valuable_neighbor(plans_)));
}

MotorPlan varied(MotorPlan plan, const Exploration& exploration, std::mt19937_64& random) {
  constexpr double min_rise_s = 0.3, max_rise_s = 1.6, max_overshoot = 0.4;  // chosen
  std::normal_distribution<double> normal;
  const double common_factor = 1 + exploration.weights * normal(random);
  for (double& weight : plan.weights_m)
    weight = weight * common_factor * (1 + exploration.weights * normal(random)) +
             exploration.weights_m * normal(random);
  plan.signal.rise_s = std::clamp(plan.signal.rise_s * std::exp(exploration.rise * normal(random)),
                                  min_rise_s, max_rise_s);
  plan.signal.overshoot = std::clamp(plan.signal.overshoot + exploration.overshoot * normal(random),
                                     -max_overshoot, max_overshoot);
  return plan;
}

int components(const Bank& bank, double fraction) {
  const auto& plans = bank.plans();
  if (plans.empty()) return 0;
  Eigen::MatrixXd weights(plans.front().weights_m.size(), std::ssize(plans));
  for (Index k = 0; k < weights.cols(); ++k)
    weights.col(k) = plans[static_cast<std::size_t>(k)].weights_m;
  const Eigen::VectorXd squares =
      Eigen::JacobiSVD<Eigen::MatrixXd>(weights).singularValues().cwiseAbs2();
  double sum = 0;
  for (Index k = 0; k < squares.size(); ++k)
    if ((sum += squares[k]) >= fraction * squares.sum()) return static_cast<int>(k) + 1;
  return static_cast<int>(squares.size());
}

}  // namespace sim::synergy

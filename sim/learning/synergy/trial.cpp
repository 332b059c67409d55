#include "sim/learning/synergy/trial.hpp"

#include <cmath>

#include "sim/learning/training_loop/random_stream.hpp"

namespace sim::synergy {

using Eigen::VectorXd;

Trial::Trial(MotorPlan plan, const TrialTimes& times, double noise, std::uint64_t seed)
    : plan_(std::move(plan)),
      times_(times),
      noise_(noise),
      random_(training_loop::random_stream(seed)) {
  line_m_ = noises_ = VectorXd::Zero(plan_.weights_m.size());
}

void Trial::add_noise(double dt_s) {
  constexpr double correlation_s = 0.1;  // chosen
  const double decay = std::exp(-dt_s / correlation_s);
  const double new_noise = noise_ * std::sqrt(1 - decay * decay);
  for (double& n : noises_) n = decay * n + new_noise * normal_(random_);
}

const VectorXd& Trial::step(double time_s) {
  if (!is_running_) is_running_ = true, begin_s_ = last_s_ = time_s;
  if (!return_path_ && elapsed_s(time_s) > end_s() + times_.watch_s)
    return_path_.emplace(times_, time_s, line_m_);
  if (return_path_) {
    done_ = return_path_->done(time_s);
    return line_m_ = return_path_->at(time_s);
  }
  add_noise(time_s - last_s_);
  last_s_ = time_s;
  return line_m_ = -plan_.signal.at(elapsed_s(time_s)) *
                   plan_.weights_m.cwiseProduct(VectorXd::Ones(noises_.size()) + noises_);
}

void Trial::see(double time_s, const Eigen::Vector3d& hand_m) {
  last_hand_m_ = hand_m;
  if (!is_running_ || return_path_ ||
      elapsed_s(time_s) < path_.sample_s * static_cast<double>(path_.at_m.size()))
    return;
  path_.at_m.push_back(hand_m);
}

TrialResult result_of(const Trial& trial, const BottleConfig& bottle, const Eigen::Vector3d& rest_m,
                      const Eigen::Vector3d& target_m) {
  TrialResult result{.outcome = evaluate(bottle, target_m, trial.path(), trial.end_s()),
                     .off_m = (trial.last_m() - rest_m).norm()};
  result.returned = result.off_m <= back_m;
  if (!result.returned) return result;
  result.credit = result.outcome.reward;
  MotorPlan& plan = result.plan.emplace(trial.plan());
  plan.at_m = rest_of(trial.path());
  const double relative_distance = (plan.at_m - target_m).norm() / bottle.zone_m;
  plan.value = std::exp(-2 * relative_distance * relative_distance) *
               evaluate(bottle, plan.at_m, trial.path(), trial.end_s()).reward;
  return result;
}

}  // namespace sim::synergy

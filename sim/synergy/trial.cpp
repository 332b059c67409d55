#include "sim/synergy/trial.hpp"

#include <cmath>

#include "sim/learner/dice.hpp"

namespace sim::synergy {

using Eigen::VectorXd;

Trial::Trial(MotorPlan plan, const TrialTimes& times, double noise, std::uint64_t seed)
    : plan_(std::move(plan)), times_(times), noise_(noise), dice_(learner::dice(seed)) {
  noises_ = VectorXd::Zero(plan_.weights_m.size());
}

void Trial::add_noise(double dt_s) {
  constexpr double correlated_s = 0.1;  // chosen
  const double kept = std::exp(-dt_s / correlated_s);
  const double fresh = noise_ * std::sqrt(1 - kept * kept);
  for (double& n : noises_) n = kept * n + fresh * normal_(dice_);
}

const VectorXd& Trial::step(double time_s, const VectorXd& line_m) {
  if (!begun_) begun_ = true, begin_s_ = last_s_ = time_s, from_m_ = line_m;
  const double dt_s = time_s - last_s_, into_s = time_s - begin_s_;
  const double planned_s = this->planned_s(time_s);
  last_s_ = time_s;
  if (planned_s < 0) {
    const double done = times_.way_s > 0 ? least_jerk(into_s / times_.way_s).done : 1;
    return line_m_ = (1 - done) * from_m_;
  }
  done_ = planned_s > end_s() + times_.watch_s;
  add_noise(dt_s);
  line_m_ = -plan_.signal.at(planned_s) *
            plan_.weights_m.cwiseProduct(VectorXd::Ones(noises_.size()) + noises_);
  return line_m_;
}

void Trial::see(double time_s, const Eigen::Vector3d& hand_m) {
  if (!begun_ || done_ ||
      planned_s(time_s) < path_.sample_s * static_cast<double>(path_.at_m.size()))
    return;
  path_.at_m.push_back(hand_m);
}

MotorPlan as_it_led(const Trial& trial, const BottleConfig& bottle,
                    const Eigen::Vector3d& target_m) {
  MotorPlan plan = trial.plan();
  plan.at_m = rest_of(trial.path());
  const double off = (plan.at_m - target_m).norm() / bottle.zone_m;
  plan.value =
      std::exp(-2 * off * off) * judge(bottle, plan.at_m, trial.path(), trial.end_s()).reward;
  return plan;
}

}  // namespace sim::synergy

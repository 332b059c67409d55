#include "sim/learning/experience/reach.hpp"

#include <cmath>

#include "sim/model/skeleton/joint_path.hpp"

namespace sim::experience {

using Eigen::Vector3d;
using Eigen::VectorXd;

Reach::Reach(Patterns patterns, Eigen::MatrixXd drives, const ReachTimes& times, Plan plan)
    : patterns_(std::move(patterns)),
      drives_(std::move(drives)),
      times_(times),
      plan_(std::move(plan)) {}

double Reach::phase_length_s() const {
  switch (phase_) {
    case Phase::approach:
      return times_.approach_s + times_.hold_s;
    case Phase::pattern:
      return patterns_.end_s() + times_.settle_s;
    case Phase::correct:
      return plan_.feedback ? times_.correct_s : 0;
    case Phase::rest:
      break;
  }
  return HUGE_VAL;
}

/// The hand position at the end of a phase is the mean over its last `mean_s`, which averages out
/// tremor.
void Reach::track_hand(double time_s, const std::optional<Vector3d>& hand_m) {
  constexpr double smooth_s = 0.1;  // of the rate; chosen
  if (!hand_m) return hand_m_.reset(), rate_m_per_s_.setZero(), void();
  const double dt_s = time_s - last_s_;
  if (hand_m_ && dt_s > 0)
    rate_m_per_s_ += -std::expm1(-dt_s / smooth_s) * ((*hand_m - *hand_m_) / dt_s - rate_m_per_s_);
  hand_m_ = hand_m;
  if (time_s < begin_s_ + phase_length_s() - times_.mean_s) return;
  sum_m_ += *hand_m, ++count_;
}

void Reach::next_phase() {
  std::optional<Vector3d> mean_m;
  if (count_ > 0) mean_m = sum_m_ / count_;
  sum_m_.setZero(), count_ = 0;
  begin_s_ += phase_length_s();
  switch (phase_) {
    case Phase::approach:
      at_start_m_ = mean_m, phase_ = Phase::pattern;
      break;
    case Phase::pattern:
      at_settled_m_ = mean_m, phase_ = Phase::correct;
      break;
    default:
      at_corrected_m_ = mean_m, phase_ = Phase::rest;
  }
}

MuscleCommand Reach::lines_to_start(double phase_s) const {
  const double fraction = minimum_jerk(phase_s / times_.approach_s).fraction;
  return {true, from_line_m_ + fraction * (plan_.start_line_m - from_line_m_)};
}

/// Zero voltage if the hand position is not known.
MuscleCommand Reach::correct() {
  if (!hand_m_) return {false, VectorXd::Zero(drives_.rows())};
  VectorXd drives_V = plan_.feedback->drives_V(plan_.target_m - *hand_m_, -rate_m_per_s_);
  const double largest_V = drives_V.cwiseAbs().maxCoeff();
  if (largest_V > times_.feedback_V) drives_V *= times_.feedback_V / largest_V, is_limited_ = true;
  return {false, drives_ * drives_V};
}

MuscleCommand Reach::step(double time_s, const VectorXd& line_m,
                          const std::optional<Vector3d>& hand_m) {
  if (!is_running_) is_running_ = true, begin_s_ = last_s_ = time_s, from_line_m_ = line_m;
  track_hand(time_s, hand_m);
  last_s_ = time_s;
  while (phase_ != Phase::rest && time_s >= begin_s_ + phase_length_s()) next_phase();
  switch (phase_) {
    case Phase::approach:
      return lines_to_start(time_s - begin_s_);
    case Phase::pattern:
      return {false, voltages_V(patterns_, drives_, plan_.scales_Vs, time_s - begin_s_)};
    case Phase::correct:
      return correct();
    case Phase::rest:
      break;
  }
  return {false, VectorXd::Zero(drives_.rows())};
}

}  // namespace sim::experience

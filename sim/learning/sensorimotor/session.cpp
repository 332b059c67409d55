#include "sim/learning/sensorimotor/session.hpp"

#include <random>

#include "sim/learning/training_loop/random_stream.hpp"

namespace sim::sensorimotor {

using Eigen::Index;
using Eigen::VectorXd;

Session::Session(const SessionOptions& options, LearnedMap learned, std::vector<Goal> goals)
    : options_(options), learned_(std::move(learned)), goals_(std::move(goals)) {
  motors_ = VectorXd::Zero(learned_.hebb().cols());
}

void Session::see(double time_s, const VectorXd& senses) {
  if (last_senses_.size() == senses.size() && (phase_ == Phase::twitch || phase_ == Phase::pause))
    learned_.associate(motors_, senses - last_senses_);
  last_senses_ = senses;
  if (time_s < end_s_ - options_.mean_s || phase_ == Phase::done) return;
  sum_of_senses_ = count_++ ? VectorXd(sum_of_senses_ + senses) : senses;
}

const VectorXd& Session::motors_N(double time_s) {
  if (!is_running_)
    is_running_ = true, begin(options_.twitches > 0 ? Phase::pause : Phase::relax, time_s);
  while (phase_ != Phase::done && time_s >= end_s_) next_phase(end_s_);
  return motors_;
}

void Session::begin(Phase phase, double time_s) {
  phase_ = phase, count_ = 0;
  if (phase != Phase::twitch && phase != Phase::reach) motors_.setZero();
  end_s_ = time_s + (phase == Phase::twitch  ? options_.twitch_s
                     : phase == Phase::pause ? options_.pause_s
                     : phase == Phase::relax ? options_.relax_s
                                             : options_.reach_s);
}

void Session::next_phase(double time_s) {
  switch (phase_) {
    case Phase::twitch:
      learned_.twitched(motors_);
      return begin(Phase::pause, time_s);
    case Phase::pause:
      if (twitches_ < options_.twitches) return begin_twitch(time_s);
      return begin(options_.trials > 0 && !goals_.empty() ? Phase::relax : Phase::done, time_s);
    case Phase::relax:
      return end_relaxing(time_s);
    case Phase::reach:
      return end_reaching(time_s);
    case Phase::done:
      break;
  }
}

void Session::begin_twitch(double time_s) {
  auto random =
      training_loop::random_stream(options_.seed, static_cast<std::uint64_t>(twitches_++));
  std::uniform_int_distribution<Index> any_muscle(0, motors_.size() - 1);
  std::uniform_real_distribution<double> force_fraction(0.5, 1);
  const Index muscle = any_muscle(random);
  motors_[muscle] = force_fraction(random) * options_.twitch_N;
  begin(Phase::twitch, time_s);
}

/// Restarts the trial if the marker was not visible during the averaging time.
bool Session::marker_was_visible(double time_s) {
  if (count_ > 0) return true;
  ++invisible_;
  begin(Phase::relax, time_s);
  return false;
}

void Session::end_relaxing(double time_s) {
  if (!marker_was_visible(time_s)) return;
  start_ = sum_of_senses_ / count_;
  desired_ = goals_[goal_].target - start_;
  motors_ = learned_.motors_N(goals_[goal_].alpha, desired_);
  if (motors_.maxCoeff() > options_.most_N) {
    motors_ *= options_.most_N / motors_.maxCoeff();
    ++limited_;
  }
  begin(Phase::reach, time_s);
}

void Session::end_reaching(double time_s) {
  if (!marker_was_visible(time_s)) return;
  learn(goals_[goal_], desired_, sum_of_senses_ / count_ - start_, options_.reach);
  if (++trials_ == options_.trials) trials_ = 0, ++goal_;
  begin(goal_ < goals_.size() ? Phase::relax : Phase::done, time_s);
}

}  // namespace sim::sensorimotor

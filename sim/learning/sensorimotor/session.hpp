#pragma once
#include <cstdint>

#include "sim/learning/sensorimotor/learned_map.hpp"

/// The experiment over time: twitches, then several trials of each goal from rest. The simulator
/// without a bus and a live graph run the same code. Time is an argument.
///
///   twitch  one random muscle contracts, then all rest; the motion during both is associated
///   relax   all muscles rest; the mean position at the end is the start of the trial
///   reach   M is constant; the mean position at the end gives the motion achieved
namespace sim::sensorimotor {

/// Described in Experiment.
struct SessionOptions {
  int twitches = 40;
  int trials = 20;
  double twitch_N = 8, twitch_s = 0.5, pause_s = 1.0;
  double relax_s = 1.5, reach_s = 1.5, mean_s = 0.2;
  double most_N = 60;
  ReachOptions reach;
  std::uint64_t seed = 1;
};

class Session {
 public:
  /// `goals` hold the targets and the initial α.
  Session(const SessionOptions& options, LearnedMap learned, std::vector<Goal> goals);

  /// Adds the senses at a time. Do not call it while the marker is not visible.
  void see(double time_s, const Eigen::VectorXd& senses);
  /// Forces by muscle, in N above rest. Times do not decrease.
  const Eigen::VectorXd& motors_N(double time_s);

  bool done() const { return phase_ == Phase::done; }
  const LearnedMap& learned() const { return learned_; }
  const std::vector<Goal>& goals() const { return goals_; }
  int limited() const { return limited_; }   ///< trials that exceeded the force limit
  int unseen() const { return invisible_; }  ///< trials repeated because the marker was not visible

 private:
  enum class Phase { twitch, pause, relax, reach, done };
  void begin(Phase phase, double time_s);
  void next_phase(double time_s);
  void begin_twitch(double time_s);
  void end_relaxing(double time_s);
  void end_reaching(double time_s);
  bool marker_was_visible(double time_s);

  SessionOptions options_;
  LearnedMap learned_;
  std::vector<Goal> goals_;
  Phase phase_ = Phase::pause;
  double end_s_ = 0;
  bool is_running_ = false;
  int twitches_ = 0, trials_ = 0, limited_ = 0, invisible_ = 0;
  std::size_t goal_ = 0;
  Eigen::VectorXd motors_, last_senses_, sum_of_senses_, start_, desired_;
  int count_ = 0;  ///< number of terms in `sum_of_senses_`
};

}  // namespace sim::sensorimotor

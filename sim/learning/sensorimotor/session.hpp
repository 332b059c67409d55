#pragma once
#include <cstdint>

#include "sim/learning/sensorimotor/learnt.hpp"

/// The experiment as it goes on in time: twitches, then each goal again and again from rest. The
/// same in the simulator without a bus and on a live graph. Pure: time is an argument.
///
///   twitch  one muscle, drawn, contracts for a while, then all rest; what moves meanwhile is tied
///   relax   all rest; where it then is, on average, is where a try begins
///   reach   M is held; where it then is, on average, tells what was moved
namespace sim::sensorimotor {

struct SessionOptions {
  int twitches = 40;                                   ///< 0: none, what is learnt already serves
  int tries = 20;                                      ///< of each goal; 0: none
  double twitch_N = 8, twitch_s = 0.5, pause_s = 1.0;  ///< of half that force to all of it; chosen
  double relax_s = 1.5, reach_s = 1.5, mean_s = 0.2;   ///< mean: at the end of either; chosen
  double most_N = 60;  ///< above rest; what asks for more is held there, and counted
  ReachOptions reach;
  std::uint64_t seed = 1;
};

class Session {
 public:
  /// Goals' targets and α as they are to begin with.
  Session(const SessionOptions& options, Learnt learnt, std::vector<Goal> goals);

  /// What is seen at a time. Not to be called while nothing is.
  void see(double time_s, const Eigen::VectorXd& senses);
  /// By muscle, above rest. Times never step back.
  const Eigen::VectorXd& motors_N(double time_s);

  bool done() const { return phase_ == Phase::done; }
  const Learnt& learnt() const { return learnt_; }
  const std::vector<Goal>& goals() const { return goals_; }
  int limited() const { return limited_; }  ///< tries that asked for more than the most
  int blind() const { return blind_; }      ///< tries begun again, because nothing was seen

 private:
  enum class Phase { twitch, pause, relax, reach, done };
  void begin(Phase phase, double time_s);
  void next(double time_s);
  void begin_twitch(double time_s);
  void end_relaxing(double time_s);
  void end_reaching(double time_s);
  bool all_seen(double time_s);

  SessionOptions options_;
  Learnt learnt_;
  std::vector<Goal> goals_;
  Phase phase_ = Phase::pause;
  double end_s_ = 0;
  bool begun_ = false;
  int twitches_ = 0, tries_ = 0, limited_ = 0, blind_ = 0;
  std::size_t goal_ = 0;
  Eigen::VectorXd motors_, last_, sum_, start_, wanted_;
  int count_ = 0;  ///< in the sum
};

}  // namespace sim::sensorimotor

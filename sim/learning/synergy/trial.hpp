#pragma once
#include <cstdint>
#include <optional>
#include <random>

#include "sim/learning/synergy/plan.hpp"
#include "sim/learning/synergy/return_path.hpp"
#include "sim/learning/synergy/strike.hpp"

/// One motor plan over time. The simulator without a bus and a live graph run the same code. Time
/// is an argument.
///
///   plan    l_m(t) = −w_m u(t) (1 + n_m(t)): signal-dependent noise n, for each muscle an
///           Ornstein–Uhlenbeck process (Harris and Wolpert 1998: proportional standard deviation)
///   watch   the lines keep their length; the hand is still recorded
///   return  the lines return to their starting lengths, and rest
namespace sim::synergy {

class Trial {
 public:
  /// `noise` is the standard deviation of n.
  Trial(MotorPlan plan, const TrialTimes& times, double noise, std::uint64_t seed);

  /// Line lengths by learned muscle, in m. Times increase. At the first call the robot is at rest
  /// at its start.
  const Eigen::VectorXd& step(double time_s);
  /// Adds the hand position. Do not call it while the position is unknown.
  void see(double time_s, const Eigen::Vector3d& hand_m);

  bool done() const { return done_; }
  const MotorPlan& plan() const { return plan_; }
  double end_s() const { return plan_.signal.rise_s + Signal::back_s; }  ///< end of the signal
  const HandPath& path() const { return path_; }                         ///< until the return
  const Eigen::Vector3d& last_m() const {
    return last_hand_m_;
  }  ///< last known position of the hand

 private:
  double elapsed_s(double time_s) const { return time_s - begin_s_; }
  void add_noise(double dt_s);

  MotorPlan plan_;
  TrialTimes times_;
  double noise_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  Eigen::VectorXd line_m_, noises_;
  std::optional<ReturnPath> return_path_;
  double begin_s_ = 0, last_s_ = 0;
  bool is_running_ = false, done_ = false;
  HandPath path_;
  Eigen::Vector3d last_hand_m_ = Eigen::Vector3d::Constant(HUGE_VAL);
};

/// Largest distance of a returned hand from its start, in m; chosen.
constexpr double back_m = 0.02;

/// Result of a trial for the bank.
///
///   v = exp(−2 |x_end − x|²/zone²) r(x_end)
///
/// A plan is stored with the place x_end that the hand reached. Its value v is the reward as if
/// x_end had been the target, reduced with the distance from the actual target x. A plan far from
/// its target predicts little about other plans near the target. At half the zone's radius the
/// factor is 0.6; chosen. If the hand did not return, the plan has dislocated a joint: the plan is
/// not stored, and its contributors receive a reward of zero.
struct TrialResult {
  Outcome outcome;
  double off_m = 0;  ///< final distance of the hand from its rest position
  bool returned = false;
  double credit = 0;
  std::optional<MotorPlan> plan;  ///< the plan to store, if any
};
TrialResult result_of(const Trial& trial, const BottleConfig& bottle, const Eigen::Vector3d& rest_m,
                      const Eigen::Vector3d& target_m);

}  // namespace sim::synergy

#pragma once
#include <cstdint>
#include <optional>
#include <random>

#include "sim/learning/synergy/plan.hpp"
#include "sim/learning/synergy/strike.hpp"
#include "sim/learning/synergy/way_back.hpp"

/// A motor plan as it goes on in time; the same in the simulator without a bus and on a live graph.
/// Pure: time is an argument.
///
///   plan   l_m(t) = −w_m u(t) (1 + n_m(t)): signal-dependent noise n, of muscles each by itself, an
///          Ornstein–Uhlenbeck process (Harris and Wolpert 1998: its deviation is in proportion)
///   watch  the lines stay; what the hand does is still watched
///   way    lines are led back to where they started, and rest
namespace sim::synergy {

class Trial {
 public:
  /// `noise`: deviation of n, a share.
  Trial(MotorPlan plan, const TrialTimes& times, double noise, std::uint64_t seed);

  /// By learnt muscle, m. Times rise; the robot is at rest where it started at the first.
  const Eigen::VectorXd& step(double time_s);
  /// Where the hand is, where that is known.
  void see(double time_s, const Eigen::Vector3d& hand_m);

  bool done() const { return done_; }
  const MotorPlan& plan() const { return plan_; }
  double end_s() const { return plan_.signal.rise_s + Signal::back_s; }  ///< of the signal
  const HandPath& path() const { return path_; }                         ///< until the way back
  const Eigen::Vector3d& last_m() const { return last_m_; }  ///< where the hand was last seen

 private:
  double into_s(double time_s) const { return time_s - begin_s_; }
  void add_noise(double dt_s);

  MotorPlan plan_;
  TrialTimes times_;
  double noise_;
  std::mt19937_64 dice_;
  std::normal_distribution<double> normal_;
  Eigen::VectorXd line_m_, noises_;
  std::optional<WayBack> way_;
  double begin_s_ = 0, last_s_ = 0;
  bool begun_ = false, done_ = false;
  HandPath path_;
  Eigen::Vector3d last_m_ = Eigen::Vector3d::Constant(HUGE_VAL);
};

/// A hand no farther from where it started has come back, m; chosen.
constexpr double back_m = 0.02;

/// What a trial teaches a bank.
///
///   v = exp(−2 |x_led − x|²/zone²) r(x_led)
///
/// A plan is stored with the place x_led to which it brought the hand, valued as if that had been its
/// target, and less the farther that is from where it was meant to lead: one that led elsewhere tells
/// little of what plans near it do. Half the zone's radius off it is worth 0.6 of one that led there;
/// chosen. A plan from which the hand did not come back has put the robot out of joint: it is not
/// stored, and those that contributed to it are credited with nothing.
struct Taught {
  Outcome outcome;
  double off_m = 0;  ///< of the hand from where it rests, at last
  bool came_back = false;
  double credit = 0;
  std::optional<MotorPlan> plan;  ///< to be stored
};
Taught taught_by(const Trial& trial, const BottleConfig& bottle, const Eigen::Vector3d& rest_m,
                 const Eigen::Vector3d& target_m);

}  // namespace sim::synergy

#pragma once
#include <cstdint>
#include <random>

#include "interfaces/xml/fields.hpp"
#include "sim/synergy/plan.hpp"
#include "sim/synergy/strike.hpp"

/// A motor plan as it goes on in time; the same in the simulator without a bus and on a live graph.
/// Pure: time is an argument.
///
///   way    lines are led back to where they started, and rest
///   plan   l_m(t) = −w_m u(t) (1 + n_m(t)): signal-dependent noise n, of muscles each by itself, an
///          Ornstein–Uhlenbeck process (Harris and Wolpert 1998: its deviation is in proportion)
///   watch  the lines stay; what the hand does is still watched
namespace sim::synergy {

struct TrialTimes {
  double way_s = 1.5, still_s = 1.5, watch_s = 1.2;  ///< chosen
  void visit(auto& v) {
    v("way_s", way_s, xml::at_least_zero);
    v("still_s", still_s, xml::at_least_zero);
    v("watch_s", watch_s, xml::positive);
  }
};

class Trial {
 public:
  /// `noise`: deviation of n, a share.
  Trial(MotorPlan plan, const TrialTimes& times, double noise, std::uint64_t seed);

  /// By learnt muscle, m. Times rise; `line_m` as lines are now, asked for once, at the beginning.
  const Eigen::VectorXd& step(double time_s, const Eigen::VectorXd& line_m);
  /// Where the hand is, where that is known.
  void see(double time_s, const Eigen::Vector3d& hand_m);

  bool done() const { return done_; }
  /// The plan has begun.
  bool planned(double time_s) const { return begun_ && planned_s(time_s) >= 0; }
  const MotorPlan& plan() const { return plan_; }
  double end_s() const { return plan_.signal.rise_s + Signal::back_s; }  ///< of the signal
  const HandPath& path() const { return path_; }                         ///< since the plan began

 private:
  double planned_s(double time_s) const {
    return time_s - begin_s_ - times_.way_s - times_.still_s;
  }
  void add_noise(double dt_s);

  MotorPlan plan_;
  TrialTimes times_;
  double noise_;
  std::mt19937_64 dice_;
  std::normal_distribution<double> normal_;
  Eigen::VectorXd from_m_, line_m_, noises_;
  double begin_s_ = 0, last_s_ = 0;
  bool begun_ = false, done_ = false;
  HandPath path_;
};

/// A plan to be stored as a trial has left it: with the place to which it brought the hand, valued as
/// if that had been its target, and less the farther that is from where it was meant to:
///
///   v = exp(−2 |x_led − x|²/zone²) r(x_led)
///
/// A plan that led elsewhere tells little of what plans near it do: the torso gave way, or the
/// shoulder. Half the zone's radius off it is worth 0.6 of one that led there; chosen.
MotorPlan as_it_led(const Trial& trial, const BottleConfig& bottle,
                    const Eigen::Vector3d& target_m);

}  // namespace sim::synergy

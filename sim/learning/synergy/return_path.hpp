#pragma once
#include <Eigen/Core>

#include "interfaces/xml/fields.hpp"
#include "sim/model/skeleton/joint_path.hpp"

/// Moves lines back to their starting lengths: wound-up lines are paid out first, then the others
/// are wound up.
///
///   l_m(t) = l_m(0) (1 − p(2 t/T))          for wound-up lines, l_m(0) < 0
///   l_m(t) = l_m(0) (1 − p(2 t/T − 1))      for paid-out lines
///
/// p rises from 0 to 1 with minimum jerk. If all lines returned together, antagonists would pull
/// against muscles that are still tense. This dislocated the torso after one plan in six, because
/// only muscles hold its shoulder blades.
namespace sim::synergy {

struct TrialTimes {
  double watch_s = 1.2, return_s = 3, hold_s = 1;
  void visit(auto& v) {
    v.former("way_s", "return_s"), v.former("still_s", "hold_s");
    v("watch_s", watch_s,
      {xml::positive, "Time for which the hand is observed after a plan began; chosen."});
    v("return_s", return_s,
      {xml::positive, "Time in which the lines return to the start; chosen."});
    v("hold_s", hold_s, {xml::at_least_zero, "Time at rest before the next plan; chosen."});
  }
};

class ReturnPath {
 public:
  /// `from_m`: current line lengths relative to the start.
  ReturnPath(const TrialTimes& times, double begin_s, Eigen::VectorXd from_m)
      : times_(times), begin_s_(begin_s), from_m_(std::move(from_m)) {}

  Eigen::VectorXd at(double time_s) const {
    const double half_periods = 2 * (time_s - begin_s_) / times_.return_s;
    const double paid_out_fraction = minimum_jerk(half_periods).fraction,
                 wound_up_fraction = minimum_jerk(half_periods - 1).fraction;
    return from_m_.unaryExpr(
        [&](double m) { return m * (1 - (m < 0 ? paid_out_fraction : wound_up_fraction)); });
  }
  /// True when the lines are back and the rest time `hold_s` has passed.
  bool done(double time_s) const { return time_s - begin_s_ > times_.return_s + times_.hold_s; }

 private:
  TrialTimes times_;
  double begin_s_;
  Eigen::VectorXd from_m_;
};

}  // namespace sim::synergy

#pragma once
#include <Eigen/Core>

#include "interfaces/xml/fields.hpp"

/// How lines are led back to where they started: what is wound up is paid out first, then the others
/// are wound up.
///
///   l_m(t) = l_m(0) (1 − p(2 t/T))          of lines wound up, l_m(0) < 0
///   l_m(t) = l_m(0) (1 − p(2 t/T − 1))      of lines paid out
///
/// p goes from 0 to 1 with the least jerk. Led back all together, antagonists pull against muscles that
/// still hold: a torso whose shoulder blades only muscles keep in place was dislocated by that after
/// one plan in six.
namespace sim::synergy {

struct TrialTimes {
  double watch_s = 1.2, way_s = 3, still_s = 1;  ///< chosen
  void visit(auto& v) {
    v("watch_s", watch_s, xml::positive);
    v("way_s", way_s, xml::positive);
    v("still_s", still_s, xml::at_least_zero);
  }
};

class WayBack {
 public:
  /// `from_m`: lines as they are, relative to where they started.
  WayBack(const TrialTimes& times, double begin_s, Eigen::VectorXd from_m)
      : times_(times), begin_s_(begin_s), from_m_(std::move(from_m)) {}

  Eigen::VectorXd at(double time_s) const;
  /// The lines are back, and the robot has had `still_s` to come to rest.
  bool done(double time_s) const { return time_s - begin_s_ > times_.way_s + times_.still_s; }

 private:
  TrialTimes times_;
  double begin_s_;
  Eigen::VectorXd from_m_;
};

}  // namespace sim::synergy

#pragma once
#include <Eigen/Core>

#include "sim/model/skeleton/joint_path.hpp"

/// A motor plan: one control signal, distributed with weights over the muscles (paper, 5.5).
///
///   l_m(t) = −w_m u(t)          line lengths, commanded to the ECUs' length laws: open loop
///   u(t) = (1 + b) p(t/T) − b p((t − T)/T_b)
///
/// p rises from 0 to 1 with minimum jerk. T is the rise time; b is the overshoot, or if negative
/// the undershoot. It has decayed at T + T_b. The weights w_m, in metres of line wound up, are
/// the plan's synergy.
namespace sim::synergy {

struct Signal {
  static constexpr double back_s = 0.4;  ///< T_b; chosen
  double rise_s = 0.8, overshoot = 0;
  double at(double time_s) const {
    return (1 + overshoot) * minimum_jerk(time_s / rise_s).fraction -
           overshoot * minimum_jerk((time_s - rise_s) / back_s).fraction;
  }
};

struct MotorPlan {
  Eigen::VectorXd weights_m;  ///< by learned muscle, positive: line wound up
  Signal signal;
  Eigen::Vector3d at_m;  ///< place that the hand reached, in the world
  double value = 1;      ///< running estimate of the reward, of its trial and of later blends
};

}  // namespace sim::synergy

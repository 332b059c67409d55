#pragma once
#include <Eigen/Core>

#include "sim/model/skeleton/joint_path.hpp"

/// A motor plan: one control signal, shared in weighted proportion among muscles (paper, 5.5).
///
///   l_m(t) = −w_m u(t)          line lengths, led by the ECUs' length laws: open loop
///   u(t) = (1 + b) p(t/T) − b p((t − T)/T_b)
///
/// p goes from 0 to 1 with the least jerk. T: how long it rises; b: by how much it goes beyond, or
/// stays behind, until T + T_b. The w_m, metres of line wound up, are the plan's synergy.
namespace sim::synergy {

struct Signal {
  static constexpr double back_s = 0.4;  ///< T_b; chosen
  double rise_s = 0.8, beyond = 0;
  double at(double time_s) const {
    return (1 + beyond) * least_jerk(time_s / rise_s).done -
           beyond * least_jerk((time_s - rise_s) / back_s).done;
  }
};

struct MotorPlan {
  Eigen::VectorXd weights_m;  ///< by learnt muscle, positive wound up
  Signal signal;
  Eigen::Vector3d at_m;  ///< where it brought the hand, in the world
  double value = 1;      ///< how rewarding it has been, by itself and as a contributor
};

}  // namespace sim::synergy

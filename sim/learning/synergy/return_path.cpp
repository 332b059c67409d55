#include "sim/learning/synergy/return_path.hpp"

#include "sim/model/skeleton/joint_path.hpp"

namespace sim::synergy {

Eigen::VectorXd ReturnPath::at(double time_s) const {
  const double half = 2 * (time_s - begin_s_) / times_.return_s;
  const double paid_out = least_jerk(half).done, wound_up = least_jerk(half - 1).done;
  return from_m_.unaryExpr([&](double m) { return m * (1 - (m < 0 ? paid_out : wound_up)); });
}

}  // namespace sim::synergy

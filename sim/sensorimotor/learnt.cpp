#include "sim/sensorimotor/learnt.hpp"

namespace sim::sensorimotor {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd Learnt::q() const {
  MatrixXd q = hebb_;
  for (Index j = 0; j < q.rows(); ++j)
    if (const double length = q.row(j).norm(); length > 0) q.row(j) /= length;
  return q;
}

VectorXd Learnt::force_per_sense_N() const {
  const MatrixXd who = q();
  VectorXd k = VectorXd::Zero(who.rows());
  for (Index j = 0; j < k.size(); ++j) {
    double moved_per_N = 0;
    for (Index m = 0; m < who.cols(); ++m)
      if (squares_[m] > 0) moved_per_N += who(j, m) * hebb_(j, m) / squares_[m];
    if (moved_per_N > 0) k[j] = 1 / moved_per_N;
  }
  return k;
}

VectorXd Learnt::motors_N(const VectorXd& alpha, const VectorXd& goal) const {
  const VectorXd asked = force_per_sense_N().cwiseProduct(alpha).cwiseProduct(goal);
  return (q().transpose() * asked).cwiseMax(0);
}

void learn(Goal& goal, const VectorXd& wanted, const VectorXd& moved, const ReachOptions& options) {
  const VectorXd error = wanted - moved;
  goal.errors.push_back(error.norm());
  for (Index j = 0; j < wanted.size(); ++j)
    goal.alpha[j] += options.rate * error[j] * wanted[j] /
                     (wanted[j] * wanted[j] + options.little * options.little);
}

}  // namespace sim::sensorimotor

#include "sim/learning/sensorimotor/learned_map.hpp"

namespace sim::sensorimotor {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd LearnedMap::moved_per_N() const {
  MatrixXd moved = hebb_;
  for (Index m = 0; m < moved.cols(); ++m)
    if (squares_[m] > 0) moved.col(m) /= squares_[m];
  return moved;
}

MatrixXd LearnedMap::q() const {
  MatrixXd q = moved_per_N();
  for (Index j = 0; j < q.rows(); ++j)
    if (const double length = q.row(j).norm(); length > 0) q.row(j) /= length;
  return q;
}

VectorXd LearnedMap::force_per_sense_N() const {
  const VectorXd moved = moved_per_N().rowwise().norm();  // Σ Q_jm (H_jm / Σ M_m²)
  return (moved.array() > 0).select(moved.cwiseInverse(), 0);
}

VectorXd LearnedMap::motors_N(const VectorXd& alpha, const VectorXd& goal) const {
  const VectorXd force_N = force_per_sense_N().cwiseProduct(alpha).cwiseProduct(goal);
  return (q().transpose() * force_N).cwiseMax(0);
}

void learn(Goal& goal, const VectorXd& desired, const VectorXd& moved,
           const ReachOptions& options) {
  const VectorXd error = desired - moved;
  goal.errors.push_back(error.norm());
  for (Index j = 0; j < desired.size(); ++j)
    goal.alpha[j] += options.rate * error[j] * desired[j] /
                     (desired[j] * desired[j] + options.regularization * options.regularization);
}

}  // namespace sim::sensorimotor

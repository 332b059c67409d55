#include "sim/learning/sensorimotor/learned_map.hpp"

namespace sim::sensorimotor {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd LearnedMap::motion_per_N() const {
  MatrixXd motion = hebb_;
  for (Index m = 0; m < motion.cols(); ++m)
    if (squares_[m] > 0) motion.col(m) /= squares_[m];
  return motion;
}

MatrixXd LearnedMap::q() const {
  MatrixXd q = motion_per_N();
  for (Index j = 0; j < q.rows(); ++j)
    if (const double length = q.row(j).norm(); length > 0) q.row(j) /= length;
  return q;
}

VectorXd LearnedMap::force_per_sense_N() const {
  const VectorXd motion = motion_per_N().rowwise().norm();  // Σ Q_jm (H_jm / Σ M_m²)
  return (motion.array() > 0).select(motion.cwiseInverse(), 0);
}

VectorXd LearnedMap::motors_N(const VectorXd& alpha, const VectorXd& goal) const {
  const VectorXd force_N = force_per_sense_N().cwiseProduct(alpha).cwiseProduct(goal);
  return (q().transpose() * force_N).cwiseMax(0);
}

void learn(Goal& goal, const VectorXd& desired, const VectorXd& motion,
           const ReachOptions& options) {
  const VectorXd error = desired - motion;
  goal.errors.push_back(error.norm());
  for (Index j = 0; j < desired.size(); ++j)
    goal.alpha[j] += options.rate * error[j] * desired[j] /
                     (desired[j] * desired[j] + options.regularization * options.regularization);
}

}  // namespace sim::sensorimotor

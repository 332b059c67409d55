#pragma once
#include "sim/learning/calibration/parameters.hpp"
#include "sim/learning/calibration/pose_set.hpp"
#include "sim/learning/training_loop/learner.hpp"

/// A robot's parameters looked for by its poses, whatever the strategy (paper, 4.4 and Fig. 5).
namespace sim::calibration {

struct Task {
  Parameters parameters;
  PoseSet poses;
};

/// Mean angle between a candidate's joints and the robot's, over joints and poses to learn from. A
/// candidate that cannot stand, such as one with a point inside its pulley, is worse than all that
/// can.
double error_rad(const Task& task, const Eigen::VectorXd& x);

/// A strategy. It begins at x = 0, the robot as robot.xml has it; the best that it has seen counts.
class Calibration : public training_loop::Learner {
 public:
  /// Throws what Equilibrium does for the robot as it is.
  explicit Calibration(Task task);

  /// Of the best: mean errors of joints, degrees, over poses to learn from and to check with; and
  /// how many poses have been judged on the way.
  std::vector<training_loop::Metric> metrics() const override;

  const Task& task() const { return task_; }
  const Eigen::VectorXd& best() const { return best_; }
  double best_error_rad() const { return best_error_rad_; }
  virtual long judged_poses() const = 0;

 protected:
  /// A candidate that has been judged.
  void found(const Eigen::VectorXd& x, double error_rad);

 private:
  Task task_;
  Eigen::VectorXd best_;
  double best_error_rad_;
  std::vector<training_loop::Metric> errors_;  ///< of the best
};

}  // namespace sim::calibration

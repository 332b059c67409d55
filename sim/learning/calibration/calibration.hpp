#pragma once
#include "sim/learning/calibration/parameters.hpp"
#include "sim/learning/calibration/pose_set.hpp"
#include "sim/learning/training_loop/training_loop.hpp"

/// Identification of a robot's parameters from its poses; common to all strategies (paper, 4.4 and
/// Fig. 5).
namespace sim::calibration {

struct Task {
  Parameters parameters;
  PoseSet poses;
};

/// Mean angle between a candidate's joints and the robot's, over joints and training poses. The
/// largest double for a candidate without an equilibrium, for example with a point inside its
/// pulley.
double error_rad(const Task& task, const Eigen::VectorXd& x);

/// A strategy. It begins at x = 0, the robot of robot.xml, and keeps the best candidate that it has
/// evaluated.
class Calibration : public training_loop::Training {
 public:
  /// Throws like Equilibrium for the robot of robot.xml.
  explicit Calibration(Task task);

  /// Mean joint errors of the best candidate in degrees, over training poses and over check poses;
  /// and the number of poses evaluated so far.
  std::vector<training_loop::Metric> metrics() const override;

  const Task& task() const { return task_; }
  const Eigen::VectorXd& best() const { return best_; }
  double best_error_rad() const { return best_error_rad_; }
  /// Number of poses evaluated so far.
  virtual long evaluated_poses() const = 0;

 protected:
  /// Stores an evaluated candidate if it is the best so far.
  void update_best(const Eigen::VectorXd& x, double error_rad);

 private:
  Task task_;
  Eigen::VectorXd best_;
  double best_error_rad_;
  std::vector<training_loop::Metric> errors_;  ///< of the best candidate
};

}  // namespace sim::calibration

#pragma once
#include "sim/learning/calibration/calibration.hpp"

namespace sim::calibration {

struct NewtonOptions {
  double sigma_rad = 7e-4;  ///< standard deviation of the measured angles: 0.04 degrees; chosen
  double sigma_Nm = 0.1;    ///< standard deviation of the torques in the first phase; chosen
  int restarts = 8;         ///< largest number of random restarts
  /// Standard deviation of a restart, relative to each parameter's spread; chosen.
  double kick = 0.15;
  std::uint64_t seed = 1;  ///< of the restarts
};

/// Calibration by damped Gauss–Newton (Levenberg, Marquardt) on the static equilibrium. A round is
/// one step.
///
///   S(x) = |r(x)|²/σ² + |x|²            (JᵀJ/σ² + 1 + λ) u = −(Jᵀ r/σ² + x)
///
/// In the first phase r is the torque needed to hold the candidate in the robot's poses, which is
/// also smooth in x far from the solution. When its steps no longer reduce S, r becomes the
/// rotation from the robot's poses to the candidate's. The prior |x|² keeps undetermined parameters
/// near robot.xml.
///
/// Slack tendons, lines that lift off pulleys, and joint stops make S non-smooth, and the
/// search may stop early. It then restarts from the best point plus a random offset, until the pose
/// error is below `sigma_rad`.
class NewtonCalibration : public Calibration {
 public:
  explicit NewtonCalibration(Task task, const NewtonOptions& options = {});

  void round(const Pool& pool) override;
  int rounds() const override { return rounds_; }
  bool done() const override { return done_; }
  long evaluated_poses() const override;
  std::string state() const override;
  void restore(const std::string& text, const std::string& file) override;

 private:
  /// S; infinite for a candidate without an equilibrium.
  double cost(const Eigen::VectorXd& x) const;
  double sigma() const { return by_torques_ ? options_.sigma_Nm : options_.sigma_rad; }
  void step(const Pool& pool);
  void continue_from(double before);
  void switch_to_angles(const Eigen::VectorXd& x);

  NewtonOptions options_;
  Eigen::VectorXd x_;
  bool by_torques_ = true;
  double cost_, damping_ = 1;
  int rounds_ = 0, restarts_ = 0;
  long evaluated_ = 0;  ///< evaluated candidates
  bool done_ = false;
};

}  // namespace sim::calibration

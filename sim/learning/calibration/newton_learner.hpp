#pragma once
#include "sim/learning/calibration/calibration.hpp"

namespace sim::calibration {

struct NewtonOptions {
  double sigma_rad = 7e-4;  ///< how well angles are known: 0.04 degrees; chosen
  double sigma_Nm = 0.1;    ///< on the way: torques are followed so well; chosen
  int kicks = 8;            ///< at most
  double kick = 0.15;       ///< of each parameter's spread, standard deviation; chosen
  std::uint64_t seed = 1;   ///< of the kicks
};

/// By Gauss–Newton on the static equilibrium, damped (Levenberg, Marquardt): a round is a step.
///
///   S(x) = |r(x)|²/σ² + |x|²            (JᵀJ/σ² + 1 + λ) u = −(Jᵀ r/σ² + x)
///
/// First r are the torques that would hold the candidate where the robot was, smooth in x from far
/// off; then, when steps bring no more, the turns from the robot's poses to the candidate's. What
/// poses do not say stays as near to robot.xml as its spread has it.
///
/// Slack tendons, pulleys left and stops make kinks at which steps end early. So from the best point
/// it goes on with a kick, until angles are followed as well as they are known.
class NewtonLearner : public Calibration {
 public:
  explicit NewtonLearner(Task task, const NewtonOptions& options = {});

  void round(const Pool& pool) override;
  int rounds() const override { return rounds_; }
  bool done() const override { return done_; }
  long judged_poses() const override;
  std::string state() const override;
  void restore(const std::string& text, const std::string& file) override;

 private:
  /// S; infinite where it cannot stand.
  double cost(const Eigen::VectorXd& x) const;
  double sigma() const { return by_torques_ ? options_.sigma_Nm : options_.sigma_rad; }
  void step(const Pool& pool);
  void go_on(double before);
  void begin_turns(const Eigen::VectorXd& x);

  NewtonOptions options_;
  Eigen::VectorXd x_;
  bool by_torques_ = true;
  double cost_, damping_ = 1;
  int rounds_ = 0, kicks_ = 0;
  long judged_ = 0;  ///< candidates
  bool done_ = false;
};

}  // namespace sim::calibration

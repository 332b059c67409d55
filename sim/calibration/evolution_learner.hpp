#pragma once
#include <functional>

#include "sim/calibration/evolution.hpp"
#include "sim/calibration/pose_set.hpp"
#include "sim/learner/learner.hpp"

/// Calibration by the evolution strategy: a round is a generation, each offspring judged by the poses
/// (paper, 4.4 and Fig. 5).
namespace sim::calibration {

class EvolutionLearner : public learner::Learner {
 public:
  /// Throws what Equilibrium does for the robot as it is.
  EvolutionLearner(Parameters parameters, PoseSet poses, const EvolutionOptions& options = {});

  void round(int threads) override;
  int rounds() const override { return evolution_.generation(); }
  /// Mean errors of joints over the poses to learn from and to check with, of the best so far.
  std::vector<learner::Metric> metrics() const override;
  std::string state() const override;
  void restore(const std::string& text, const std::string& file) override;

  /// Normalised.
  const Eigen::VectorXd& best() const { return best_.x; }
  const Parameters& parameters() const { return parameters_; }

 private:
  void judge(Individual& individual) const;

  Parameters parameters_;
  PoseSet poses_;
  EvolutionOptions options_;
  Evolution evolution_;
  Individual best_;
};

}  // namespace sim::calibration

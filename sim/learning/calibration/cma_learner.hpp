#pragma once
#include <memory>

#include "sim/learning/calibration/calibration.hpp"
#include "sim/learning/calibration/evolution.hpp"

namespace sim::calibration {

/// By covariance matrix adaptation, pagmo's CMA-ES (Hansen 2006): a round is a generation of as many
/// as the evolution strategy's offspring, with its first step size and bounds. pagmo judges one
/// candidate after the other, so a pool does not make it faster.
class CmaLearner : public Calibration {
 public:
  explicit CmaLearner(Task task, const EvolutionOptions& options = {});
  ~CmaLearner() override;

  void round(const Pool& pool) override;
  int rounds() const override;
  long judged_poses() const override;
  std::string state() const override;
  void restore(const std::string& text, const std::string& file) override;

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace sim::calibration

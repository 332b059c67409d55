#pragma once
#include "sim/learning/calibration/calibration.hpp"
#include "sim/learning/calibration/evolution.hpp"

namespace sim::calibration {

/// By the evolution strategy: a round is a generation.
class EvolutionLearner : public Calibration {
 public:
  explicit EvolutionLearner(Task task, const EvolutionOptions& options = {});

  void round(const Pool& pool) override;
  int rounds() const override { return evolution_.generation(); }
  long judged_poses() const override;
  std::string state() const override;
  void restore(const std::string& text, const std::string& file) override;

 private:
  EvolutionOptions options_;
  Evolution evolution_;
};

}  // namespace sim::calibration

#pragma once
#include "sim/learning/calibration/calibration.hpp"
#include "sim/learning/calibration/evolution.hpp"

namespace sim::calibration {

/// Calibration by the evolution strategy: a round is one generation.
class EvolutionCalibration : public Calibration {
 public:
  explicit EvolutionCalibration(Task task, const EvolutionOptions& options = {});

  void round(const Pool& pool) override;
  int rounds() const override { return evolution_.generation(); }
  long evaluated_poses() const override;
  std::string state() const override;
  void restore(const std::string& text, const std::string& file) override;

 private:
  EvolutionOptions options_;
  Evolution evolution_;
};

}  // namespace sim::calibration

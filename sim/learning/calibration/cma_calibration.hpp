#pragma once
#include <memory>

#include "sim/learning/calibration/calibration.hpp"
#include "sim/learning/calibration/evolution.hpp"

namespace sim::calibration {

/// Calibration by covariance matrix adaptation, pagmo's CMA-ES (Hansen 2006). A round is one
/// generation, with the population size, initial step size and bounds of the evolution strategy.
/// pagmo evaluates candidates one after the other. A pool therefore does not make it faster.
class CmaCalibration : public Calibration {
 public:
  explicit CmaCalibration(Task task, const EvolutionOptions& options = {});
  ~CmaCalibration() override;

  void round(const Pool& pool) override;
  int rounds() const override;
  long evaluated_poses() const override;
  std::string state() const override;
  void restore(const std::string& text, const std::string& file) override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sim::calibration

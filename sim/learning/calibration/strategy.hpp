#pragma once
#include <memory>

#include "sim/learning/calibration/calibration.hpp"

/// The list of strategies.
namespace sim::calibration {

enum class Strategy { evolution, cma, newton };

struct StrategyOptions {
  Strategy strategy = Strategy::evolution;
  std::uint64_t seed = 1;
  int parents = 6;     ///< of the evolution strategy
  int offspring = 36;  ///< of the evolution strategy and of CMA-ES
  double bound = 3;    ///< of both: largest distance from robot.xml, in spreads
};

/// Throws like Calibration, and std::invalid_argument for a strategy that was not built.
std::unique_ptr<Calibration> make_calibration(Task task, const StrategyOptions& options);

}  // namespace sim::calibration

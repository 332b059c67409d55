#pragma once
#include <memory>

#include "sim/learning/calibration/calibration.hpp"

/// The strategies as a list.
namespace sim::calibration {

enum class Strategy { evolution, cma, newton };

struct StrategyOptions {
  Strategy strategy = Strategy::evolution;
  std::uint64_t seed = 1;
  int parents = 6;     ///< of the evolution strategy
  int offspring = 36;  ///< of that and of CMA-ES
  double bound = 3;    ///< of those: spreads from robot.xml at most
};

/// Throws as Calibration, and std::invalid_argument for one that was not built.
std::unique_ptr<Calibration> make_calibration(Task task, const StrategyOptions& options);

}  // namespace sim::calibration

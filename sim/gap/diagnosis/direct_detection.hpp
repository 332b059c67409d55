#pragma once
#include <vector>

#include "sim/gap/diagnosis/answer.hpp"
#include "sim/gap/diagnosis/bus.hpp"
#include "sim/gap/diagnosis/problem.hpp"

/// Detection without a fit to residuals: age of the commands, quantization step of sensor readings.
namespace sim::diagnosis {

struct Detected {
  std::vector<IdentifiedEffect> bus;      ///< best first; the first may be supported
  std::vector<IdentifiedEffect> sensors;  ///< quantization steps larger than on the data sheet
  double late = 0;                        ///< share of ticks whose command was not the newest
  bool bus_evaluated = false;             ///< the recordings determine which commands were followed

  bool bus_differs() const { return !bus.empty() && bus[0].supported; }
  /// Commands are late, and no effect of the bus explains their ages.
  bool bus_unexplained() const { return late > practical_late && !bus_differs(); }
};

Detected detect_directly(const Problem& problem, const Evaluator& plain);

}  // namespace sim::diagnosis

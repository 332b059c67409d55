#pragma once
#include <vector>

#include "sim/gap/diagnosis/answer.hpp"
#include "sim/gap/diagnosis/bus.hpp"
#include "sim/gap/diagnosis/problem.hpp"

/// Detection without a fit to residuals: age of commands, quantization steps of sensor readings.
namespace sim::diagnosis {

struct Detected {
  std::vector<IdentifiedEffect> bus;      ///< best first; the first may be supported
  std::vector<IdentifiedEffect> sensors;  ///< quantization steps larger than on the data sheet
  double delayed_fraction = 0;            ///< of ticks, whose command was not the newest
  bool bus_evaluated = false;             ///< the recordings determine the applied commands

  bool bus_differs() const { return !bus.empty() && bus[0].supported; }
  /// Commands are delayed, and no effect of the bus explains their ages.
  bool bus_unexplained() const {
    return delayed_fraction > negligible_delayed_fraction && !bus_differs();
  }
};

Detected detect_directly(const Problem& problem, const Evaluator& baseline);

}  // namespace sim::diagnosis

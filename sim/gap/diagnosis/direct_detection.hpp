#pragma once
#include <vector>

#include "sim/gap/diagnosis/answer.hpp"
#include "sim/gap/diagnosis/bus.hpp"
#include "sim/gap/diagnosis/problem.hpp"

/// What recordings show without a fit to residuals: how old commands are, how coarse readings are.
namespace sim::diagnosis {

struct Detected {
  std::vector<IdentifiedEffect> bus;      ///< best first; the first may be supported
  std::vector<IdentifiedEffect> sensors;  ///< coarser than their data sheets; the readings show it
  double late = 0;                        ///< share of ticks whose command was not the newest
  bool bus_evaluated = false;  ///< the recordings allow to tell which commands were followed

  bool bus_differs() const { return !bus.empty() && bus[0].supported; }
  /// Commands are late as no effect of the bus has it.
  bool bus_unexplained() const { return late > practical_late && !bus_differs(); }
};

Detected detect_directly(const Problem& problem, const Evaluator& plain);

}  // namespace sim::diagnosis

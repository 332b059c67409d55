#pragma once
#include <iosfwd>
#include <string>
#include <vector>

#include "interfaces/recording/table.hpp"

/// `erp log effort`: tensions and energy of each muscle.
namespace launch {

struct Effort {
  std::string actuator;
  double least_N = 0, mean_N = 0, largest_N = 0;
  double ripple_N = 0;  ///< RMS of the tension about a straight line fitted over 0.1 s: oscillation
  double energy_J = 0;  ///< ∫ V i dt: net energy from the supply
};

/// Ignores rows before `from_s` and empty cells.
std::vector<Effort> efforts(const recording::Table& table, double from_s);

/// Prints one row per muscle and the total energy. Returns 0 done, 1 not written, 2 bad input.
int log_effort(const std::string& path, double from_s, std::ostream& out);

}  // namespace launch

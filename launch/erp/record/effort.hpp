#pragma once
#include <iosfwd>
#include <string>
#include <vector>

#include "interfaces/recording/table.hpp"

/// `erp log effort`: what a motion took, muscle by muscle.
namespace launch {

struct Effort {
  std::string actuator;
  double least_N = 0, mean_N = 0, largest_N = 0;
  double swing_N = 0;   ///< RMS of the tension about its straight line over 0.1 s: what oscillates
  double energy_J = 0;  ///< ∫ V i dt: what the supply gave, less what it got back
};

/// Rows before `from_s` are left out, and cells that were not taken.
std::vector<Effort> efforts(const recording::Table& table, double from_s);

/// Prints a row a muscle and their sum. Returns 0 done, 1 could not be written, 2 bad input.
int log_effort(const std::string& path, double from_s, std::ostream& out);

}  // namespace launch

#pragma once
#include <span>
#include <string>
#include <vector>

#include "sim/gap/residuals/episode.hpp"

/// Rows that a bus spoilt, seen in the sensors alone: reports that were lost, in whose place the last one
/// is repeated, and rows taken a little later than they are stamped.
namespace sim::estimation {

struct RepeatedRows {
  double share = 0;         ///< of all rows; 0: none that a standing robot would not give
  std::size_t longest = 0;  ///< in a row
};

/// A row in which no sensor differs from the row before, next to rows in which a shaft turns by more than
/// two of its steps.
RepeatedRows repeated_rows(std::span<const residuals::Episode> episodes);

/// How much later than stamped rows are, at most, evenly between 0 and that; 0: nothing seen.
///
///   e_k = x_k − (4 (x_{k−1} + x_{k+1}) − (x_{k−2} + x_{k+2}))/6     of each shaft and joint
///   var δ = Σ e_a e_b ω_a ω_b / (35/18 Σ ω_a² ω_b²)                over pairs of sensors, a ≠ b
///
/// A time that all sensors share moves each by its speed; the noise of one is not that of another.
/// 35/18: what the filter makes of white noise. Clear only above six standard errors.
double row_jitter_s(std::span<const residuals::Episode> episodes);

/// In repeated rows angles and tensions are what lies between their neighbours, up to ten rows; voltages,
/// currents and longer ones are forgotten. Notes both in the episodes. Adds a line to `remarks` for each that is there.
void repair_defective_rows(std::vector<residuals::Episode>& episodes,
                           std::vector<std::string>& remarks);

}  // namespace sim::estimation

#pragma once
#include <span>
#include <string>
#include <vector>

#include "sim/gap/residuals/episode.hpp"

/// Rows with defects caused by a bus, detected from the sensors alone: lost reports, in whose place the last one is
/// repeated, and rows sampled a little later than their time stamp.
namespace sim::estimation {

struct RepeatedRows {
  double share = 0;         ///< of the rows in which a shaft turns; 0: none
  std::size_t longest = 0;  ///< longest sequence of repeated rows
};

/// Detects rows in which no sensor differs from the row before, while a shaft turns by more than two of its steps per
/// row.
RepeatedRows repeated_rows(std::span<const residuals::Episode> episodes);

/// The largest delay of rows after their time stamps, for delays uniform between 0 and it; 0: none detected.
///
///   e_k = x_k − (4 (x_{k−1} + x_{k+1}) − (x_{k−2} + x_{k+2}))/6     of each shaft and joint
///   var δ = Σ e_a e_b ω_a ω_b / (35/18 Σ ω_a² ω_b²)                over pairs of sensors, a ≠ b
///
/// A delay δ that all sensors share shifts each by its speed ω; the noise of the sensors is independent. 35/18: factor
/// of the filter on the variance of white noise. Detected only above six standard errors.
double row_jitter_s(std::span<const residuals::Episode> episodes);

/// Interpolates angles and tensions in up to ten successive repeated rows; in longer sequences, and for voltages and
/// currents, the samples become NaN. Stores both defects in the episodes, and adds a line to `remarks` for each.
void repair_defective_rows(std::vector<residuals::Episode>& episodes,
                           std::vector<std::string>& remarks);

}  // namespace sim::estimation

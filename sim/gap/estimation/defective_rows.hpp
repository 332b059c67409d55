#pragma once
#include <span>
#include <string>
#include <vector>

#include "sim/gap/residuals/episode.hpp"

/// Defects of rows that a bus causes, detected from the sensors: repetitions of the last report in
/// place of a lost one, and rows that were sampled a little after their time stamp.
namespace sim::estimation {

struct RepeatedRows {
  double fraction = 0;      ///< of the rows in which a shaft turns; 0: no repeated rows
  std::size_t longest = 0;  ///< longest sequence of repeated rows
};

/// Detects rows in which no sensor differs from the row before although a shaft turns by more than
/// two encoder steps per row.
RepeatedRows repeated_rows(std::span<const residuals::Episode> episodes);

/// Returns the largest delay of rows after their time stamps in s, for uniformly distributed
/// delays; 0: not detected.
///
///   e_k = x_k − (4 (x_{k−1} + x_{k+1}) − (x_{k−2} + x_{k+2}))/6     of each shaft and joint
///   var δ = Σ e_a e_b ω_a ω_b / (35/18 Σ ω_a² ω_b²)                over pairs of sensors, a ≠ b
///
/// A common delay δ shifts the reading x of each sensor by δ ω, ω: its speed. The noise of the
/// sensors is independent. 35/18: gain of the filter for the variance of white noise. A delay is
/// detected only above six standard errors.
double row_jitter_s(std::span<const residuals::Episode> episodes);

/// Interpolates angles and tensions in up to ten successive repeated rows. In longer sequences, and
/// for voltages and currents, the samples become NaN. Stores fraction and jitter in the episodes,
/// and adds a line to `remarks` for each defect.
void repair_defective_rows(std::vector<residuals::Episode>& episodes,
                           std::vector<std::string>& remarks);

}  // namespace sim::estimation

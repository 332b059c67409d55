#pragma once
#include <span>
#include <string>
#include <vector>

#include "sim/gap/residuals/episode.hpp"

/// The meaning of a row of a recording. A voltage that holds from its row to the next, or a command that acts late, is
/// detected by the motor's law and compensated.
///
///   V_k−s ≈ R i_k + K ω_k + L di/dt_k + c        s: the voltage of a row acts s rows later
///
/// R, K, L and c are fitted, so no constant of the robot takes part. s = 0: a voltage holds until its row, as in this
/// product's own recordings. s = 1: from its row. s > 1: it acts late, or the sensors are reported late.
namespace sim::estimation {

struct RowTiming {
  std::size_t rows = 0;  ///< s, the same for every actuator
  double period_s = 0;
  bool from_row() const { return rows == 1; }
  bool late() const { return rows > 1; }
  double delay_s() const { return double(rows) * period_s; }
};

/// Detects the lag of all recordings of one robot. It is 0 unless every actuator shows the same lag and it leaves less
/// than a third of the variance: a lag of one sensor is no lag of rows.
RowTiming row_timing(std::span<const residuals::Episode> episodes);

/// Shifts voltages, and for s = 1 also modes and references; stores the delay in the episodes. Adds a line to `remarks`
/// if there is a lag.
void undo(const RowTiming& timing, std::vector<residuals::Episode>& episodes,
          std::vector<std::string>& remarks);

}  // namespace sim::estimation

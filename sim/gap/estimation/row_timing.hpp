#pragma once
#include <span>
#include <string>
#include <vector>

#include "sim/gap/residuals/episode.hpp"

/// The timing of voltages relative to the rows of a recording. A voltage that is held from its row
/// to the next, or a delayed voltage, is detected by the motor's law and compensated.
///
///   V_k−s ≈ R i_k + K ω_k + L di/dt_k + c        s: the voltage of a row acts s rows later
///
/// R, K, L and c are fitted; no constant of the robot is used. s = 0: a voltage is held until its
/// row, as in recordings by `erp record`. s = 1: it is held from its row. s > 1: the voltages or
/// the reports of the sensors are delayed.
namespace sim::estimation {

struct RowTiming {
  std::size_t rows = 0;  ///< s, equal for all actuators
  double period_s = 0;
  bool from_row() const { return rows == 1; }
  bool is_delayed() const { return rows > 1; }
  double delay_s() const { return double(rows) * period_s; }
};

/// Detects the lag s of all recordings of one robot. It is 0 unless all actuators have the same lag
/// and the lag leaves less than a third of the variance. The lag of a single sensor is not a lag of
/// rows.
RowTiming row_timing(std::span<const residuals::Episode> episodes);

/// Shifts voltages, and for s = 1 also modes and references. Stores the delay in the episodes. Adds
/// a line to `remarks` if there is a lag.
void compensate(const RowTiming& timing, std::vector<residuals::Episode>& episodes,
                std::vector<std::string>& remarks);

}  // namespace sim::estimation

#pragma once
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "interfaces/recording/table.hpp"
#include "interfaces/robot/robot.hpp"

/// A recording, arranged for a robot: rows at even times, signals by actuator and joint.
namespace sim::residuals {

/// Empty: not recorded. NaN: this sample is missing.
using Signal = std::vector<double>;

/// Central difference, in the signal's unit per second; 0 at the first and last row.
inline double rate_of(const Signal& signal, std::size_t row, double period_s) {
  if (row == 0 || row + 1 >= signal.size()) return 0;
  return (signal[row + 1] - signal[row - 1]) / (2 * period_s);
}

inline constexpr double tick_s = 0.002;  ///< period of the ECU firmware

/// The median time between two rows, and the rms deviation of a row from even times. Both are 0 for
/// fewer than two rows.
struct RowTimes {
  double period_s = 0, jitter_s = 0;
};
RowTimes row_times(const recording::Table& table);

struct ActuatorSignals {
  Signal mode, reference, voltage_V, current_A, shaft_rad, tension_N;
  bool current_around = false;  ///< current_A is the mean around a row, not the value at the row
  /// Set-points in counts: the newest one that was sent to the ECU before the row, and the one that
  /// the ECU applied. NaN if their modes differ; empty: not recorded.
  Signal sent = {}, followed = {};
};

/// The angle of a revolute joint, or the quaternion w x y z of a spherical joint.
struct JointSignals {
  Signal angle_rad;
  std::array<Signal, 4> quaternion;
};

struct Episode {
  std::string name;
  double period_s = 0;
  std::size_t rows = 0;
  std::vector<ActuatorSignals> actuators;  ///< in the order of the robot
  std::vector<JointSignals> joints;
  /// Judged rows: `judged_from` … `judged_until` − 1. Effects with state start at the first row of
  /// the recording.
  std::size_t judged_from = 0, judged_until = std::numeric_limits<std::size_t>::max();

  /// Delay of the applied voltages, or of all sensors, relative to the recorded times; already
  /// compensated.
  double voltage_delay_s = 0;
  double repeated_fraction = 0;  ///< of rows that repeat the row before; already repaired
  double jitter_s = 0;           ///< largest delay of a row after its time stamp

  void judge_from(double time_s) {
    judged_from = static_cast<std::size_t>(std::lround(time_s / period_s));
  }
  bool judged(std::size_t row) const { return judged_from <= row && row < judged_until; }
};

/// Checks a table and arranges it for a robot whose drives are chains (drives.hpp). The rows are
/// put on an even grid: rows that repeat a time are dropped, missing rows become NaN. Outliers
/// become NaN. Up to three NaN in succession are interpolated. Each correction is reported in
/// `remarks`. If the frames are numbered by the device's ticks (column `sequence`), the times are
/// computed from the ticks because real-time stamps have jitter. Throws std::invalid_argument:
/// fewer than ten rows, no column of this robot, a gap of more than a minute, times in another
/// unit, times of arrival.
Episode lay_out(const recording::Table& table, const erp::Robot& robot, const std::string& name,
                std::vector<std::string>& remarks);

}  // namespace sim::residuals

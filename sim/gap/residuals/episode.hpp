#pragma once
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "interfaces/recording/table.hpp"
#include "interfaces/robot/robot.hpp"

/// A recording laid out for a robot: rows at even times, its signals by actuator and joint.
namespace sim::residuals {

/// Empty: not recorded. NaN: this sample was not taken.
using Signal = std::vector<double>;

/// Central difference, 1/s of the signal's unit; 0 at the ends.
inline double rate_of(const Signal& signal, std::size_t row, double period_s) {
  if (row == 0 || row + 1 >= signal.size()) return 0;
  return (signal[row + 1] - signal[row - 1]) / (2 * period_s);
}

inline constexpr double tick_s = 0.002;  ///< the firmware's period

/// The usual time between two rows, and by how much, rms, a row comes early or late; 0: there are not
/// two.
struct RowTimes {
  double period_s = 0, jitter_s = 0;
};
RowTimes row_times(const recording::Table& table);

struct ActuatorSignals {
  Signal mode, reference, voltage_V, current_A, shaft_rad, tension_N;
  bool current_around = false;  ///< it is the mean around a row, not what was at its instant
  /// Set-points in counts: the newest that was sent to the ECU before, and what it followed; NaN
  /// where they are of two modes; empty: nobody recorded them.
  Signal sent = {}, followed = {};
};

/// A revolute joint's angle, or a spherical one's quaternion w x y z.
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
  /// Rows that are judged, before `judged_until`. What remembers begins with the first row all the
  /// same.
  std::size_t judged_from = 0, judged_until = std::numeric_limits<std::size_t>::max();

  /// By how much later than recorded voltages act, or all sensors are; undone already.
  double voltage_late_s = 0;
  double repeated_share = 0;  ///< of rows that were the row before again; filled in already
  double jitter_s = 0;        ///< up to how much later than stamped rows are taken

  void judge_from(double time_s) {
    judged_from = static_cast<std::size_t>(std::lround(time_s / period_s));
  }
  bool judged(std::size_t row) const { return judged_from <= row && row < judged_until; }
};

/// Checks a table and lays it out for a robot whose drives are chains (drives.hpp). Times are put
/// on an even grid: rows that repeat a time are dropped, rows that are missing become NaN; single
/// samples far off both neighbours become NaN, and up to three NaN in a row are interpolated. What
/// was done is told in `remarks`. Throws std::invalid_argument: no row, no column of this robot, a
/// gap of more than a minute, times of arrival. Where frames are numbered by the device's ticks
/// (column `sequence`), those are the time: stamps in real time come early and late.
Episode lay_out(const recording::Table& table, const erp::Robot& robot, const std::string& name,
                std::vector<std::string>& remarks);

}  // namespace sim::residuals

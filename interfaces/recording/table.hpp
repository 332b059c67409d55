#pragma once
#include <limits>
#include <string>
#include <string_view>
#include <vector>

/// A recording as a table: one row per cycle, one column per signal.
/// ```
///   time_s                    time since the first row
///   sequence                  sequence number of the frame: the device's tick (on request)
///   <a>.mode                  mode of the ECU (erp::Mode as a number; a name in CSV)
///   <a>.reference             V, m (change of line length since the start), A or N, by mode
///   <a>.voltage_V             commanded by the ECU
///   <a>.current_A
///   <a>.shaft_rad             gearbox output, positive = winding up
///   <a>.tension_N
///   <a>.line_m                change of line length since the start (on request)
///   <a>.target_mode, .target  desired by a planner in answer to this row's frame (on request)
///   ecu<e>.<c>.sent_request, .sent   last set-point sent to an ECU channel before this row, in its
///                             counts (on request, from MCAP)
///   ecu<e>.<c>.followed_request, .followed   set-point that the channel followed in this row, in its
///                             counts (on request, from MCAP)
///   <j>.angle_rad             a revolute joint
///   <j>.qw … <j>.qz           a spherical joint
///   <d>.control_V             control signal of a drive, from this row to the next
///   <d>.position_m            position of a drive's slide; <d>.position_rad of its shaft
///   <d>.reference_m, .reference_rad   reference position of a drive
///   <d>.pulse_V               part of control_V: pulses of a drive
/// ```
namespace recording {

inline constexpr double not_taken = std::numeric_limits<double>::quiet_NaN();

struct Column {
  std::string name;
  std::vector<double> values;  ///< NaN: the sample was not taken
};

struct Table {
  std::vector<Column> columns;
  std::size_t rows() const { return columns.empty() ? 0 : columns.front().values.size(); }
  const Column* find(std::string_view name) const;  ///< nullptr: no such column
  /// The names that have a column `<name>.<signal>`, in the order of the columns.
  std::vector<std::string> owners(std::string_view signal) const;
};

/// The valid signals at the end of a column's name, "mode" first.
const std::vector<std::string_view>& known_signals();
/// "flexor.tension_N" → "tension_N"; the whole name when it has no dot.
std::string_view signal_of(std::string_view column);
/// Whether the values of the column are modes (erp::Mode).
bool holds_mode(std::string_view column);
/// Prefix of the columns of an ECU channel: "ecu0.1".
std::string channel_name(int ecu, int channel);

struct TableOptions {
  std::string robot;       ///< empty: the only robot in the recording
  bool sequences = false;  ///< include sequence, from MCAP
  bool lines = false;      ///< include <a>.line_m
  bool targets = false;    ///< include <a>.target_mode and <a>.target
  bool sent = false;       ///< include sent and followed set-points
  /// Source of spherical joints; empty: motion_capture if recorded, else sim.
  std::string pose_source;
};

/// Reads a recording (MCAP) or a table (CSV); detects the format by the first bytes. Throws
/// RecordingError with place, value, remedy.
Table read_table(const std::string& path, const TableOptions& options = {});

class McapReader;
/// One row per sensor_frame, in the order of stamps. A spherical joint that is not in sensor_frame
/// comes from joint_state: a row takes its last sample that is newer than the previous row and not
/// newer than this row. An actuator_target belongs to the row with the sequence in its `answers`.
Table table_of(const McapReader& recording, const TableOptions& options = {});

}  // namespace recording

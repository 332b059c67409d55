#include "sim/gap/residuals/episode.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>

#include "interfaces/recording/columns.hpp"
#include "interfaces/xml/values.hpp"
#include "sim/gap/residuals/drives.hpp"
#include "sim/gap/residuals/signal_noise.hpp"

namespace sim::residuals {
namespace {

constexpr double longest_gap_s = 60;           // chosen
constexpr double longest_period_s = 0.5;       // chosen: no recording has longer periods
constexpr std::size_t longest_filled_gap = 3;  // rows; chosen
constexpr std::size_t fewest_rows = 10;        // chosen

/// For each row of the table, its row on the even grid; −1: dropped.
struct Grid {
  double period_s = 0;
  std::size_t rows = 0;
  std::vector<std::ptrdiff_t> row_of;
  std::size_t repeated = 0, missing = 0;
};

/// The probable unit of times that are not in seconds, and the number of units in a second, from
/// the period.
std::pair<const char*, double> unit_of_time(double period) {
  if (period < 500) return {"milliseconds", 1e3};
  if (period < 5e5) return {"microseconds", 1e6};
  return {"nanoseconds", 1e9};
}

void check_seconds(double period_s, const std::string& name) {
  if (!(period_s > 0))
    throw std::invalid_argument(name +
                                ": time_s: most rows have the time of the row before: times are "
                                "rounded or rows repeated; write all digits, and each row once");
  if (!(period_s > longest_period_s)) return;
  const auto [unit, in_a_second] = unit_of_time(period_s);
  throw std::invalid_argument(name + ": time_s: rows are " + xml::write_number(period_s) +
                              " s apart; if the times are " + unit + ", divide them by " +
                              xml::write_number(in_a_second));
}

Grid even_grid(const std::vector<double>& time_s, const std::string& name) {
  if (time_s.size() < fewest_rows)
    throw std::invalid_argument(name + ": fewer than ten rows; record some seconds of motion");
  std::vector<double> steps(time_s.size() - 1);
  for (std::size_t k = 0; k < steps.size(); ++k) steps[k] = time_s[k + 1] - time_s[k];
  Grid grid{median(steps), 0, {}, 0, 0};
  check_seconds(grid.period_s, name);
  std::ptrdiff_t row = -1;
  // The filter follows the drift of a clock, but not the delay of a single row.
  double expected_s = time_s[0];
  constexpr double filter_gain = 0.1;  // chosen
  for (std::size_t k = 0; k < time_s.size(); ++k) {
    const double periods = k == 0 ? 1 : (time_s[k] - expected_s) / grid.period_s;
    if (periods * grid.period_s > longest_gap_s)
      throw std::invalid_argument(name + ": no rows for " +
                                  xml::write_number(periods * grid.period_s) + " s before " +
                                  xml::write_number(time_s[k]) + " s; cut the recording there");
    if (periods < 0.5) {
      grid.row_of.push_back(-1), ++grid.repeated;
      continue;
    }
    const auto row_steps = static_cast<std::ptrdiff_t>(std::lround(periods));
    grid.missing += static_cast<std::size_t>(row_steps - 1);
    row += row_steps;
    grid.row_of.push_back(row);
    expected_s += double(row_steps) * grid.period_s;
    expected_s = row == 0 ? time_s[0] : std::lerp(expected_s, time_s[k], filter_gain);
  }
  grid.rows = static_cast<std::size_t>(row + 1);
  return grid;
}

/// Whether the frames are numbered by the firmware's ticks, without a restart.
bool counts_ticks(const recording::Column& tick, const recording::Column& time) {
  std::vector<double> period;
  for (std::size_t k = 1; k < tick.values.size(); ++k) {
    const double ticks = tick.values[k] - tick.values[k - 1];
    if (!(ticks > 0)) return false;
    period.push_back((time.values[k] - time.values[k - 1]) / ticks);
  }
  return !period.empty() && std::abs(median(period) / tick_s - 1) < 0.1;
}

std::vector<double> times_of(const recording::Column& tick) {
  std::vector<double> time_s;
  for (const double n : tick.values) time_s.push_back((n - tick.values.front()) * tick_s);
  return time_s;
}

Signal on_grid(const Grid& grid, const recording::Column* column) {
  if (!column || std::ranges::all_of(column->values, [](double x) { return std::isnan(x); }))
    return {};
  Signal signal(grid.rows, recording::not_taken);
  for (std::size_t k = 0; k < grid.row_of.size(); ++k)
    if (grid.row_of[k] >= 0) signal[static_cast<std::size_t>(grid.row_of[k])] = column->values[k];
  return signal;
}

/// Removes samples that are far from both neighbours while the neighbours are near each other.
std::size_t drop_outliers(Signal& signal) {
  std::vector<double> steps;
  for (std::size_t k = 1; k < signal.size(); ++k)
    if (const double step = std::abs(signal[k] - signal[k - 1]); step > 0) steps.push_back(step);
  constexpr double far_steps = 30, near_steps = 5;  // in median steps; chosen
  if (steps.size() < 10) return 0;
  const double median_step = median(steps);
  std::size_t dropped = 0;
  for (std::size_t k = 1; k + 1 < signal.size(); ++k) {
    const double before = signal[k] - signal[k - 1], after = signal[k] - signal[k + 1];
    const bool is_isolated =
        before * after > 0 && std::abs(signal[k + 1] - signal[k - 1]) < near_steps * median_step;
    if (is_isolated && std::min(std::abs(before), std::abs(after)) > far_steps * median_step)
      signal[k] = recording::not_taken, ++dropped;
  }
  return dropped;
}

std::size_t fill_short_gaps(Signal& signal) {
  std::size_t filled = 0;
  for (std::size_t k = 1; k < signal.size(); ++k) {
    if (!std::isnan(signal[k]) || std::isnan(signal[k - 1])) continue;
    std::size_t end = k;
    while (end < signal.size() && std::isnan(signal[end])) ++end;
    if (end == signal.size() || end - k > longest_filled_gap) continue;
    const double first = signal[k - 1], slope = (signal[end] - first) / double(end - k + 1);
    for (std::size_t j = k; j < end; ++j) signal[j] = first + slope * double(j - k + 1), ++filled;
  }
  return filled;
}

/// q and −q are the same rotation. Each sample gets the sign that is nearer to the sample before.
void make_continuous(std::array<Signal, 4>& q) {
  std::size_t last = 0;
  for (std::size_t k = 1; k < q[0].size(); ++k) {
    if (std::isnan(q[0][k])) continue;
    double product = 0;
    for (const Signal& part : q) product += part[k] * part[last];
    if (product < 0)
      for (Signal& part : q) part[k] = -part[k];
    last = k;
  }
  for (Signal& part : q) fill_short_gaps(part);
}

/// Arranges one table and reports the corrections.
class Layout {
 public:
  Layout(const recording::Table& table, std::string name, std::vector<std::string>& remarks)
      : table_(table), name_(std::move(name)), remarks_(remarks) {
    const recording::Column* time = table.find("time_s");
    if (!time) throw std::invalid_argument(name_ + ": no column time_s");
    const recording::Column* tick = table.find("sequence");
    grid_ = even_grid(tick && counts_ticks(*tick, *time) ? times_of(*tick) : time->values, name_);
    if (100 * grid_.repeated > grid_.row_of.size())
      throw std::invalid_argument(
          name_ + ": " + std::to_string(grid_.repeated) + " of " +
          std::to_string(grid_.row_of.size()) +
          " rows follow another by less than half a period: their times are times of arrival, not "
          "of measurement; use a recording with frame numbers (column sequence) or even times");
    if (grid_.repeated)
      remark(rows(grid_.repeated, "repeats a time", "repeat a time") + "; dropped");
    if (grid_.missing) remark(rows(grid_.missing, "is missing", "are missing"));
  }
  const Grid& grid() const { return grid_; }

  /// A signal without jumps; its outliers and short gaps are corrected.
  Signal smooth(const std::string& column) {
    Signal signal = held(column);
    if (const auto n = drop_outliers(signal))
      remark(column + ": " + std::to_string(n) +
             (n == 1 ? " outlier dropped" : " outliers dropped"));
    fill_short_gaps(signal);
    return signal;
  }
  /// A signal that may jump.
  Signal held(const std::string& column) { return on_grid(grid_, table_.find(column)); }

 private:
  static std::string rows(std::size_t count, const char* singular, const char* plural) {
    return count == 1 ? std::string("1 row ") + singular
                      : std::to_string(count) + " rows " + plural;
  }
  void remark(const std::string& what) { remarks_.push_back(name_ + ": " + what); }
  const recording::Table& table_;
  std::string name_;
  std::vector<std::string>& remarks_;
  Grid grid_;
};

DriveRecord<Signal> drive_record(Layout& layout, const erp::Drive& drive) {
  const auto name = drive_columns(drive);
  return {layout.held(name.control_V), layout.smooth(name.position), layout.held(name.current_A),
          layout.smooth(name.load), layout.smooth(name.torque)};
}

/// Adds the set-points that were sent to an actuator's ECU and those that the ECU applied.
void add_set_points(Layout& layout, const erp::Actuator& actuator, ActuatorSignals& signals) {
  const std::string channel = recording::channel_name(actuator.ecu, actuator.channel);
  signals.sent = layout.held(channel + ".sent");
  signals.followed = layout.held(channel + ".followed");
  const Signal sent_as = layout.held(channel + ".sent_request"),
               followed_as = layout.held(channel + ".followed_request");
  if (signals.sent.empty() || signals.followed.empty()) signals.sent = signals.followed = {};
  for (std::size_t k = 0; k < signals.sent.size(); ++k)
    if (sent_as[k] != followed_as[k]) signals.sent[k] = recording::not_taken;
}

/// Names of a robot's columns, as examples for a message.
std::string columns_of(const erp::Robot& robot) {
  std::string names;
  for (const erp::Drive& drive : robot.drives) {
    const auto columns = drive_columns(drive);
    names += (names.empty() ? "" : ", ") + columns.control_V + ", " + columns.position;
  }
  return names.empty() ? "<actuator>.current_A, <actuator>.shaft_rad, <joint>.angle_rad, …" : names;
}

}  // namespace

RowTimes row_times(const recording::Table& table) {
  const recording::Column* time = table.find("time_s");
  const recording::Column* tick = table.find("sequence");
  if (!time || time->values.size() < 2) return {};
  const auto times = tick && counts_ticks(*tick, *time) ? times_of(*tick) : time->values;
  std::vector<double> steps;
  for (std::size_t k = 1; k < times.size(); ++k) steps.push_back(times[k] - times[k - 1]);
  std::vector<double> reordered = steps;
  const double period_s = median(reordered);
  double square = 0;
  for (const double step : steps) square += std::pow(std::remainder(step, period_s), 2);
  // A deviation of one row changes two steps.
  return {period_s, std::sqrt(square / 2 / double(steps.size()))};
}

Episode lay_out(const recording::Table& table, const erp::Robot& robot, const std::string& name,
                std::vector<std::string>& remarks) {
  Layout layout(table, name, remarks);
  Episode episode{name, layout.grid().period_s, layout.grid().rows, {}, {}};
  bool has_motion = false;
  for (const erp::Actuator& actuator : robot.actuators) {
    if (const erp::Drive* drive = drive_of(robot, actuator.name)) {
      episode.actuators.push_back(drive_signals(*drive, drive_record(layout, *drive)));
      has_motion |= !episode.actuators.back().shaft_rad.empty();
      continue;
    }
    const std::string a = actuator.name + ".";
    episode.actuators.push_back({layout.held(a + "mode"), layout.held(a + "reference"),
                                 layout.held(a + "voltage_V"), layout.held(a + "current_A"),
                                 layout.smooth(a + "shaft_rad"), layout.smooth(a + "tension_N")});
    add_set_points(layout, actuator, episode.actuators.back());
    const ActuatorSignals& s = episode.actuators.back();
    has_motion |= !s.voltage_V.empty() || !s.current_A.empty() || !s.shaft_rad.empty() ||
                  !s.tension_N.empty();
  }
  for (const erp::Joint& joint : robot.joints()) {
    JointSignals& signals = episode.joints.emplace_back();
    if (const erp::Drive* drive = drive_of(robot, joint.name)) {
      signals.angle_rad = load_rad(*drive, drive_record(layout, *drive));
      continue;
    }
    signals.angle_rad = layout.smooth(joint.name + ".angle_rad");
    for (std::size_t k = 0; k < 4; ++k)
      signals.quaternion[k] = layout.held(joint.name + "." + recording::quaternion_parts[k]);
    if (std::ranges::none_of(signals.quaternion, &Signal::empty))
      make_continuous(signals.quaternion);
    else signals.quaternion = {};
    has_motion |= !signals.angle_rad.empty() || !signals.quaternion[0].empty();
  }
  if (!has_motion)
    throw std::invalid_argument(name + ": no column of robot \"" + robot.name +
                                "\" with a motion; expected columns: " + columns_of(robot));
  return episode;
}

}  // namespace sim::residuals

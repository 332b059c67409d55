#include "launch/erp/record/summary.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iostream>

#include "interfaces/recording/error.hpp"
#include "interfaces/recording/mcap_reader.hpp"
#include "launch/erp/record/run_quality.hpp"

namespace launch {
namespace {

constexpr double complete_fraction = 0.98;  // a shorter recording is reported; chosen

using Samples = std::vector<double>;

/// The signal that a mode controls.
const char* measured_signal(erp::Mode mode) {
  switch (mode) {
    case erp::Mode::voltage:
      return ".voltage_V";
    case erp::Mode::length:
      return ".line_m";
    case erp::Mode::current:
      return ".current_A";
    case erp::Mode::force:
      return ".tension_N";
    case erp::Mode::off:
      break;
  }
  return "";
}

/// Target and measured value of one actuator, in rows that have both.
struct TrackedActuator {
  std::string actuator;
  erp::Mode mode = erp::Mode::off;
  Samples time_s, target, measured;
};

/// Columns of the desired value of an actuator: the published target, or without a target the
/// reference of the ECU. A voltage is not a target, because no control loop tracks it.
struct DesiredColumns {
  const recording::Column *mode = nullptr, *value = nullptr;
  explicit operator bool() const { return mode && value; }
};

DesiredColumns desired_columns(const recording::Table& table, const std::string& actuator) {
  const DesiredColumns target{table.find(actuator + ".target_mode"),
                              table.find(actuator + ".target")};
  if (target) return target;
  return {table.find(actuator + ".mode"), table.find(actuator + ".reference")};
}

TrackedActuator tracked_actuator(const recording::Table& table, const std::string& actuator) {
  TrackedActuator tracked{actuator, erp::Mode::off, {}, {}, {}};
  const auto [modes, values] = desired_columns(table, actuator);
  const auto* ecu_mode = table.find(actuator + ".mode");
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (std::isnan(values->values[row]) || std::isnan(modes->values[row])) continue;
    const auto mode = static_cast<erp::Mode>(std::lround(modes->values[row]));
    if (mode == erp::Mode::off || mode == erp::Mode::voltage) continue;
    if (tracked.mode == erp::Mode::off) tracked.mode = mode;
    const auto* measured = table.find(actuator + measured_signal(mode));
    if (mode != tracked.mode || !measured || std::isnan(measured->values[row])) continue;
    if (ecu_mode && !(ecu_mode->values[row] > 0)) continue;
    tracked.time_s.push_back(table.columns.front().values[row]);
    tracked.target.push_back(values->values[row]);
    tracked.measured.push_back(measured->values[row]);
  }
  return tracked;
}

std::vector<TrackedActuator> tracked_actuators(const recording::Table& table) {
  std::vector<TrackedActuator> all;
  for (const auto& actuator : table.owners("mode"))
    if (desired_columns(table, actuator))
      if (auto tracked = tracked_actuator(table, actuator); !tracked.target.empty())
        all.push_back(std::move(tracked));
  return all;
}

double rms_error(const TrackedActuator& tracked, std::size_t first_row) {
  double sum = 0;
  for (std::size_t i = first_row; i < tracked.target.size(); ++i)
    sum += (tracked.measured[i] - tracked.target[i]) * (tracked.measured[i] - tracked.target[i]);
  return std::sqrt(sum / static_cast<double>(tracked.target.size() - first_row));
}

/// The row of the only change of the target; empty if there is no change or more than one.
std::optional<std::size_t> single_step(const Samples& target) {
  std::optional<std::size_t> step;
  for (std::size_t i = 1; i < target.size(); ++i) {
    if (target[i] == target[i - 1]) continue;
    if (step) return std::nullopt;
    step = i;
  }
  return step;
}

/// First time, from row `start` on, at which the measured signal reaches `level`.
std::optional<double> crossing_time_s(const TrackedActuator& tracked, std::size_t start,
                                      double level, bool upward) {
  for (std::size_t i = start; i < tracked.measured.size(); ++i)
    if (upward ? tracked.measured[i] >= level : tracked.measured[i] <= level)
      return tracked.time_s[i];
  return std::nullopt;
}

StepResponse response_of(const TrackedActuator& tracked, std::size_t step) {
  StepResponse response{tracked.actuator,
                        tracked.mode,
                        tracked.target[step - 1],
                        tracked.target[step],
                        tracked.time_s[step],
                        {},
                        0,
                        0};
  const double height = response.step_target - response.previous_target;
  const auto at_10_percent_s =
      crossing_time_s(tracked, step, response.previous_target + 0.1 * height, height > 0);
  const auto at_90_percent_s =
      crossing_time_s(tracked, step, response.previous_target + 0.9 * height, height > 0);
  if (at_10_percent_s && at_90_percent_s) response.rise_s = *at_90_percent_s - *at_10_percent_s;
  for (std::size_t i = step; i < tracked.measured.size(); ++i)
    response.overshoot = std::max(
        response.overshoot, (tracked.measured[i] - response.step_target) * (height > 0 ? 1 : -1));
  response.steady_rms = rms_error(tracked, step + (tracked.target.size() - step) / 2);
  return response;
}

/// The value with its unit; lengths in mm.
std::string value_text(double value, erp::Mode mode) {
  if (mode == erp::Mode::length) return fmt::format("{:.3f} mm", 1000 * value);
  return fmt::format("{:.3f} {}", value, erp::unit_of(mode));
}

}  // namespace

std::vector<Tracking> tracking(const recording::Table& table) {
  std::vector<Tracking> all;
  for (const auto& tracked : tracked_actuators(table)) {
    Tracking t{tracked.actuator, tracked.mode, rms_error(tracked, 0), 0, tracked.target.size()};
    for (std::size_t i = 0; i < tracked.target.size(); ++i)
      t.largest = std::max(t.largest, std::abs(tracked.measured[i] - tracked.target[i]));
    all.push_back(t);
  }
  return all;
}

std::vector<StepResponse> step_responses(const recording::Table& table) {
  std::vector<StepResponse> all;
  for (const auto& tracked : tracked_actuators(table))
    if (const auto step = single_step(tracked.target)) all.push_back(response_of(tracked, *step));
  return all;
}

namespace {

void print_tracking(const std::vector<Tracking>& tracks, std::ostream& out) {
  if (tracks.empty()) return;
  out << fmt::format("{:<20} {:<8} {:>14} {:>14}\n", "actuator", "mode", "RMS error", "largest");
  for (const auto& t : tracks)
    out << fmt::format("{:<20} {:<8} {:>14} {:>14}\n", t.actuator, erp::name_of(t.mode),
                       value_text(t.rms, t.mode), value_text(t.largest, t.mode));
}

void print_steps(const std::vector<StepResponse>& steps, std::ostream& out) {
  for (const auto& s : steps)
    out << fmt::format(
        "{} steps {} -> {} at {:.3f} s: rise (10-90 %) {}, overshoot {}, steady RMS {}\n",
        s.actuator, value_text(s.previous_target, s.mode), value_text(s.step_target, s.mode),
        s.at_s, s.rise_s ? fmt::format("{:.0f} ms", 1000 * *s.rise_s) : "not reached",
        value_text(s.overshoot, s.mode), value_text(s.steady_rms, s.mode));
}

/// If the logger was killed and restarted, the earlier parts are NAME.1.mcap, NAME.2.mcap …
void print_parts(const std::vector<std::string>& parts, std::ostream& out) {
  if (parts.size() == 1) {
    out << "recording " << parts.front() << '\n';
    return;
  }
  out << "recording in " << parts.size() << " parts, because the logger was restarted:\n";
  for (const auto& part : parts) out << "  " << part << '\n';
  out << "recover an incomplete part with: erp log recover PART\n";
}

}  // namespace

int print_summary(const RecordedRun& run, std::ostream& out) try {
  print_parts(run.parts, out);
  if (run.active_s < 0) return 0;  // the device never ran
  recording::TableOptions options;
  options.lines = options.targets = true;
  options.robot = run.robot.name;
  const recording::McapReader recording(run.parts.back());
  const auto table = recording::table_of(recording, options);
  const double span_s = table.columns.front().values.back();
  out << fmt::format("{} {:.2f} s", run.parts.size() > 1 ? "the last part covers" : "it covers",
                     span_s)
      << (span_s < complete_fraction * run.active_s
              ? fmt::format(" of the run's {:.2f} s", run.active_s)
              : "")
      << '\n';
  print_tracking(tracking(table), out);
  print_steps(step_responses(table), out);
  print_quality(recording, table, run.robot, out);
  return 0;
} catch (const recording::RecordingError& error) {
  std::cerr << error.what() << '\n';
  return 1;
}

}  // namespace launch

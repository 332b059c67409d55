#include "sim/gap/checks/table_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "interfaces/xml/words.hpp"
#include "sim/gap/residuals/drives.hpp"
#include "sim/gap/residuals/episode.hpp"

namespace sim::checks {
namespace {

std::vector<std::string> parts_of(const erp::Robot& robot) {
  std::vector<std::string> names;
  for (const auto& drive : robot.drives) names.push_back(drive.name);
  for (const auto& actuator : robot.actuators) {
    names.push_back(actuator.name);
    names.push_back(recording::channel_name(actuator.ecu, actuator.channel));
  }
  for (const auto& joint : robot.joints()) names.push_back(joint.name);
  for (const auto& sensor : robot.joint_sensors)
    if (sensor.about) names.push_back(erp::sample_name(sensor));
  return names;
}

/// Name of the part that a column belongs to; empty for a column without a part, such as the time.
std::string part_of(const std::string& column) {
  const auto dot = column.rfind('.');
  return dot == column.npos ? "" : column.substr(0, dot);
}

std::vector<std::string> unknown_columns(const recording::Table& table, const erp::Robot& robot,
                                         const std::string& name) {
  const auto known_parts = parts_of(robot);
  std::vector<std::string> parts, reports;
  for (const auto& column : table.columns) {
    const std::string part = part_of(column.name);
    if (part.empty() || std::ranges::count(known_parts, part) || std::ranges::count(parts, part))
      continue;
    parts.push_back(part);
    const auto columns = std::ranges::count_if(
        table.columns, [&](const auto& c) { return part_of(c.name) == part; });
    reports.push_back(fmt::format("{}: column {}{} is ignored: robot \"{}\" has no part \"{}\"; {}",
                                  name, column.name,
                                  columns > 1 ? fmt::format(" (and {} more)", columns - 1) : "",
                                  robot.name, part, xml::did_you_mean(part, known_parts)));
  }
  return reports;
}

/// Whether a period is near the ECUs' period but differs by more than the drift of a clock.
bool is_another_clock(double period_s) {
  constexpr double max_drift = 0.005, max_deviation = 0.2;  // of the period; chosen
  const double deviation = std::abs(period_s / residuals::tick_s - 1);
  return deviation > max_drift && deviation < max_deviation;
}

}  // namespace

std::vector<std::string> table_checks(const recording::Table& table, const erp::Robot& robot,
                                      const std::string& name) {
  std::vector<std::string> reports = unknown_columns(table, robot, name);
  const bool has_ecus = std::ranges::any_of(
      robot.actuators, [&](const auto& a) { return !residuals::drive_of(robot, a.name); });
  constexpr double largest_jitter = 0.03;       // of a period; chosen
  constexpr double largest_row_distance = 1.5;  // in periods of the ECUs; chosen
  const auto [period_s, jitter_s] = residuals::row_times(table);
  if (has_ecus && period_s > largest_row_distance * residuals::tick_s)
    reports.push_back(fmt::format(
        "{}: time_s has one row per {:.3g} ms, but the ECUs' period is {:g} ms: a gap at a motor "
        "or gearbox may be caused by the missing rows; record one row per {:g} ms; if the rows "
        "have that period, correct time_s",
        name, 1e3 * period_s, 1e3 * residuals::tick_s, 1e3 * residuals::tick_s));
  if (has_ecus && jitter_s < largest_jitter * period_s && is_another_clock(period_s))
    reports.push_back(
        fmt::format("{}: time_s has one row per {:.4g} ms, but the ECUs' period is {:g} ms: its "
                    "clock runs {:.2g} % too {}, and every speed has this error; scale time_s",
                    name, 1e3 * period_s, 1e3 * residuals::tick_s,
                    100 * std::abs(period_s / residuals::tick_s - 1),
                    period_s > residuals::tick_s ? "fast" : "slowly"));
  if (jitter_s > largest_jitter * period_s)
    reports.push_back(fmt::format(
        "{}: time_s deviates by {:.2g} ms rms from an even period of {:.3g} ms; the rows are "
        "treated as even; if these are times of arrival, record the times of measurement, or the "
        "frame numbers in a column sequence; if they are rounded, write all digits",
        name, 1e3 * jitter_s, 1e3 * period_s));
  return reports;
}

}  // namespace sim::checks

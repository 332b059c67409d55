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

/// Whom a column is of; empty: of nobody, as the time.
std::string owner_of(const std::string& column) {
  const auto dot = column.rfind('.');
  return dot == column.npos ? "" : column.substr(0, dot);
}

std::vector<std::string> strangers(const recording::Table& table, const erp::Robot& robot,
                                   const std::string& name) {
  const auto known = parts_of(robot);
  std::vector<std::string> owners, suspicious;
  for (const auto& column : table.columns) {
    const std::string owner = owner_of(column.name);
    if (owner.empty() || std::ranges::count(known, owner) || std::ranges::count(owners, owner))
      continue;
    owners.push_back(owner);
    const auto columns = std::ranges::count_if(
        table.columns, [&](const auto& c) { return owner_of(c.name) == owner; });
    suspicious.push_back(fmt::format("{}: {}{}: robot \"{}\" has no \"{}\": {}", name, column.name,
                                     columns > 1 ? fmt::format(" and {} more", columns - 1) : "",
                                     robot.name, owner, xml::did_you_mean(owner, known)));
  }
  return suspicious;
}

/// Near the ECUs' period, but off by more than a clock is.
bool is_another_clock(double period_s) {
  constexpr double drift = 0.005, near = 0.2;  // of the period; chosen
  const double off = std::abs(period_s / residuals::tick_s - 1);
  return off > drift && off < near;
}

}  // namespace

std::vector<std::string> table_checks(const recording::Table& table, const erp::Robot& robot,
                                      const std::string& name) {
  std::vector<std::string> suspicious = strangers(table, robot, name);
  const bool has_ecus = std::ranges::any_of(
      robot.actuators, [&](const auto& a) { return !residuals::drive_of(robot, a.name); });
  constexpr double much = 0.03;  // of a period; chosen
  const auto [period_s, jitter_s] = residuals::row_times(table);
  if (has_ecus && period_s > 1.5 * residuals::tick_s)
    suspicious.push_back(fmt::format(
        "{}: time_s: a row each {:.3g} ms, the ECUs' period is {:g} ms: gaps of motors "
        "and gearboxes may be what is missing between the rows: record one each {:g} ms; if "
        "they are that close, time_s is stretched",
        name, 1e3 * period_s, 1e3 * residuals::tick_s, 1e3 * residuals::tick_s));
  if (has_ecus && jitter_s < much * period_s && is_another_clock(period_s))
    suspicious.push_back(
        fmt::format("{}: time_s: a row each {:.4g} ms, the ECUs' period is {:g} ms: its clock runs "
                    "{:.2g} % too {}; scale time_s, or every speed is wrong by that",
                    name, 1e3 * period_s, 1e3 * residuals::tick_s,
                    100 * std::abs(period_s / residuals::tick_s - 1),
                    period_s > residuals::tick_s ? "fast" : "slowly"));
  if (jitter_s > much * period_s)
    suspicious.push_back(fmt::format(
        "{}: time_s: rows come {:.2g} ms rms before and after an even {:.3g} ms: they are "
        "laid out as even; if these are times of arrival, give those of measurement, or "
        "the frames' numbers in a column sequence; if they are rounded, all digits",
        name, 1e3 * jitter_s, 1e3 * period_s));
  return suspicious;
}

}  // namespace sim::checks

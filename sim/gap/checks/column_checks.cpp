#include "sim/gap/checks/column_checks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/gap/checks/corrections.hpp"
#include "sim/gap/checks/dead_columns.hpp"
#include "sim/gap/residuals/drives.hpp"
#include "sim/model/actuator/sensors.hpp"

namespace sim::checks {
namespace {

constexpr double beyond_stops = 3;          // times the largest angle of the stops; chosen
constexpr double smallest_stop_rad = 0.3;   // for joints with stops near 0; chosen
constexpr double smallest_fraction = 0.02;  // of the rows at the end of a range; chosen

/// A converter at the end of its range. Its readings are bounds, not values.
struct AtLimit {
  Column column;
  double limit = 0;     ///< in the column's unit
  double fraction = 0;  ///< of the valid rows
};

/// Fraction of the valid rows in which the magnitude is at least `limit`.
double fraction_beyond(const Signal& signal, double limit) {
  double beyond = 0, valid = 0;
  for (const double x : signal)
    if (std::isfinite(x)) beyond += std::abs(x) >= limit, ++valid;
  return valid > 0 ? beyond / valid : 0;
}

/// Currents and tensions that are at the end of their range in more than 2 % of the rows. The zero
/// tension of a slack tendon is not an end of the range.
std::vector<AtLimit> at_limit(const Episode& episode, const erp::Robot& robot) {
  std::vector<AtLimit> columns;
  const auto add_if_at_limit = [&](const Column& column, const Signal& signal, int counts,
                                   double per_count) {
    const double fraction = fraction_beyond(signal, (counts - 0.5) * per_count);
    if (fraction > smallest_fraction) columns.push_back({column, counts * per_count, fraction});
  };
  for (std::size_t a = 0; a < robot.actuators.size(); ++a) {
    const erp::Actuator& actuator = robot.actuators[a];
    if (residuals::drive_of(robot, actuator.name)) continue;  // its converters are not described
    const SensorScale scale(robot.motor_of(actuator), robot.sensors_of(actuator));
    const residuals::ActuatorSignals& measured = episode.actuators[a];
    add_if_at_limit({Quantity::current, a}, measured.current_A, scale.current_counts_max,
                    scale.current_A_per_count);
    add_if_at_limit({Quantity::tension, a}, measured.tension_N,
                    scale.tension_counts_max - scale.tension_zero_counts,
                    scale.tension_N_per_count);
  }
  return columns;
}

class Messages {
 public:
  Messages(const Episode& episode, const erp::Robot& robot) : e_(episode), robot_(robot) {}

  std::string names(const std::vector<Column>& columns) const {
    constexpr std::size_t max_names = 4;
    std::vector<std::string> listed;
    for (std::size_t k = 0; k < std::min(max_names, columns.size()); ++k)
      listed.push_back(name_of(columns[k], e_, robot_));
    if (columns.size() > max_names)
      listed.push_back(fmt::format("{} more", columns.size() - max_names));
    return fmt::format("{}", fmt::join(listed, " and "));
  }
  std::string of(const DeadColumn& dead) const {
    const std::string when = dead.whole_recording ? "in the whole recording"
                                                  : fmt::format("from {:.3g} s to {:.3g} s",
                                                                double(dead.first) * e_.period_s,
                                                                double(dead.end) * e_.period_s);
    return fmt::format(
        "{} is constant at {:.4g} {} while {} change{}: the signal is dead; repair the sensor, or "
        "remove {}",
        names({dead.column}), dead.value, when, names(dead.evidence),
        dead.evidence.size() == 1 ? "s" : "", dead.whole_recording ? "the column" : "these rows");
  }
  std::string of(const AtLimit& at) const {
    return fmt::format(
        "{} is at the end of its range, {:.4g}, in {:.2g} % of the rows: larger values are not "
        "recorded; empty these cells, or record motions that need less",
        names({at.column}), at.limit, 100 * at.fraction);
  }
  std::string of(const Correction& m) const {
    switch (m.kind) {
      case Correction::Kind::contradicting:
        return names(m.columns) + " contradict each other; check their signs, units and channels";
      case Correction::Kind::exchanged:
        return exchanged(m);
      case Correction::Kind::scaled:
        break;
    }
    const std::string expected = "the value expected from " + names(m.evidence);
    const char* remedy = *m.remedy ? m.remedy : "check its unit";
    std::string text = names(m.columns);
    if (m.factor < 0)
      text += fmt::format(" has the opposite sign of {}; multiply the column by -1", expected);
    if (std::abs(m.factor) == 1) return text;
    if (m.factor < 0)
      return text + fmt::format("; its magnitude is {:.4g} times the expected one; {}",
                                std::abs(m.factor), remedy);
    return text + fmt::format(" is {:.4g} times {}; {}", m.factor, expected, remedy);
  }
  std::string of(const Alternatives& alternatives) const {
    std::vector<std::string> texts;
    for (const Correction& correction : alternatives) texts.push_back(of(correction));
    return fmt::format("{}", fmt::join(texts, "; or "));
  }

 private:
  std::string exchanged(const Correction& m) const {
    const auto half = m.columns.begin() + std::ptrdiff_t(m.columns.size() / 2);
    const bool all_columns = m.columns.size() > 2;
    const auto name = [&](const Column& c) {
      return all_columns ? robot_.actuators[c.of].name : name_of(c, e_, robot_);
    };
    return fmt::format("{} and {} seem exchanged{}; exchange {}", name(m.columns[0]), name(*half),
                       all_columns ? " in all their columns" : "",
                       all_columns ? "their names" : "the columns");
  }

  const Episode& e_;
  const erp::Robot& robot_;
};

/// Joints whose recorded angles go far beyond their stops.
std::vector<std::size_t> beyond_their_stops(const Episode& episode,
                                            const std::vector<erp::Joint>& joints) {
  std::vector<std::size_t> beyond;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    if (joints[j].type != erp::JointType::revolute) continue;
    const double largest =
        std::max({std::abs(joints[j].min_rad), std::abs(joints[j].max_rad), smallest_stop_rad});
    if (std::ranges::any_of(episode.joints[j].angle_rad,
                            [&](double x) { return std::abs(x) > beyond_stops * largest; }))
      beyond.push_back(j);
  }
  return beyond;
}

std::string beyond_stops_message(const erp::Joint& joint, const Signal& angle) {
  double largest = 0;
  for (const double x : angle) largest = std::fmax(largest, std::abs(x));
  return fmt::format(
      "{}.angle_rad has values up to {:.3g} rad, but the stops are at {:g} and {:g} rad; if the "
      "values are degrees, divide the column by 57.29578",
      joint.name, largest, joint.min_rad, joint.max_rad);
}

/// Whether a correction changes the column. A column in another unit is already reported when it
/// exceeds its range.
bool is_corrected(const std::vector<Alternatives>& all, const Column& column) {
  return std::ranges::any_of(all, [&](const Alternatives& alternatives) {
    return std::ranges::any_of(alternatives, [&](const Correction& m) {
      return std::ranges::count(m.columns, column) > 0;
    });
  });
}

}  // namespace

std::vector<std::string> column_checks(const Episode& episode, const erp::Robot& robot) {
  const Messages messages(episode, robot);
  const auto joints = robot.joints();
  Laws laws(robot);
  std::vector<std::string> reports;
  const auto report = [&](const std::string& message) {
    reports.push_back(episode.name + ": " + message);
  };
  Means means = laws.means(episode, 0, episode.rows);
  for (const DeadColumn& dead : dead_columns(episode, robot, laws))
    report(messages.of(dead)), means.remove(dead.column);
  for (const std::size_t j : beyond_their_stops(episode, joints)) {
    report(beyond_stops_message(joints[j], episode.joints[j].angle_rad));
    means.scale({Quantity::angle, j}, std::numbers::pi / 180);
  }
  laws.compute_paths(means);
  const auto proposed = corrections(robot, laws, std::move(means));
  for (const Alternatives& alternatives : proposed) report(messages.of(alternatives));
  for (const AtLimit& at : at_limit(episode, robot))
    if (!is_corrected(proposed, at.column)) report(messages.of(at));
  return reports;
}

}  // namespace sim::checks

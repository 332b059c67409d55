#include "sim/gap/checks/column_checks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/gap/checks/at_limit.hpp"
#include "sim/gap/checks/corrections.hpp"
#include "sim/gap/checks/dead_columns.hpp"

namespace sim::checks {
namespace {

constexpr double beyond_stops = 3;  // times the widest; chosen

class Words {
 public:
  Words(const Episode& episode, const erp::Robot& robot) : e_(episode), robot_(robot) {}

  std::string names(const std::vector<Column>& columns) const {
    constexpr std::size_t most = 4;
    std::vector<std::string> all;
    for (std::size_t k = 0; k < std::min(most, columns.size()); ++k)
      all.push_back(name_of(columns[k], e_, robot_));
    if (columns.size() > most) all.push_back(fmt::format("{} more", columns.size() - most));
    return fmt::format("{}", fmt::join(all, " and "));
  }
  std::string of(const DeadColumn& dead) const {
    const std::string when =
        dead.all_along ? "all the time"
                       : fmt::format("from {:.3g} s to {:.3g} s", double(dead.from) * e_.period_s,
                                     double(dead.until) * e_.period_s);
    return fmt::format(
        "{} is {:.4g} {} while {} move{}: it looks dead: mend the sensor, or leave {} out",
        names({dead.column}), dead.value, when, names(dead.evidence),
        dead.evidence.size() == 1 ? "s" : "", dead.all_along ? "the column" : "those rows");
  }
  std::string of(const AtLimit& at) const {
    return fmt::format(
        "{} stands at the end of its range, {:.4g}, in {:.2g} % of the rows: what was beyond is "
        "not "
        "in the recording: leave these cells empty, or record less of it",
        names({at.column}), at.limit, 100 * at.share);
  }
  std::string of(const Correction& m) const {
    const std::string evidence = names(m.evidence);
    switch (m.kind) {
      case Correction::Kind::contradicting:
        return names(m.columns) + " contradict each other: check their signs, units and channels";
      case Correction::Kind::exchanged:
        return exchanged(m);
      case Correction::Kind::scaled:
        break;
    }
    std::string text = names(m.columns) + ": ";
    if (m.times < 0)
      text += fmt::format("its sign is against {}: multiply the column by -1", evidence);
    if (std::abs(m.times) == 1) return text;
    return text + fmt::format("{}{:.4g} times what {} foretell{}: {}", m.times < 0 ? "; " : "",
                              std::abs(m.times), evidence, m.evidence.size() == 1 ? "s" : "",
                              *m.like ? m.like : "check its unit");
  }
  std::string of(const Either& either) const {
    std::vector<std::string> all;
    for (const Correction& mending : either) all.push_back(of(mending));
    return fmt::format("{}", fmt::join(all, "; or "));
  }

 private:
  std::string exchanged(const Correction& m) const {
    const auto half = m.columns.begin() + std::ptrdiff_t(m.columns.size() / 2);
    const bool whole = m.columns.size() > 2;
    const auto name = [&](const Column& c) {
      return whole ? robot_.actuators[c.of].name : name_of(c, e_, robot_);
    };
    return fmt::format("{} and {}: {}look exchanged: exchange {}", name(m.columns[0]), name(*half),
                       whole ? "all their columns " : "", whole ? "their names" : "the columns");
  }

  const Episode& e_;
  const erp::Robot& robot_;
};

/// Columns whose angles go far beyond what their joints can, in the robot's unit.
std::vector<std::size_t> beyond_their_stops(const Episode& episode,
                                            const std::vector<erp::Joint>& joints) {
  std::vector<std::size_t> beyond;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    if (joints[j].type != erp::JointType::revolute) continue;
    const double widest = std::max({std::abs(joints[j].min_rad), std::abs(joints[j].max_rad), 0.3});
    if (std::ranges::any_of(episode.joints[j].angle_rad,
                            [&](double x) { return std::abs(x) > beyond_stops * widest; }))
      beyond.push_back(j);
  }
  return beyond;
}

std::string far_beyond(const erp::Joint& joint, const Signal& angle) {
  double largest = 0;
  for (const double x : angle) largest = std::fmax(largest, std::abs(x));
  return fmt::format(
      "{}.angle_rad: goes to {:.3g}, its stops are at {:g} and {:g} rad: if these are degrees, "
      "divide by 57.29578",
      joint.name, largest, joint.min_rad, joint.max_rad);
}

/// A column in another unit is beyond its range, of course.
bool corrects(const std::vector<Either>& all, const Column& column) {
  return std::ranges::any_of(all, [&](const Either& either) {
    return std::ranges::any_of(
        either, [&](const Correction& m) { return std::ranges::count(m.columns, column) > 0; });
  });
}

}  // namespace

std::vector<std::string> column_checks(const Episode& episode, const erp::Robot& robot) {
  const Words words(episode, robot);
  const auto joints = robot.joints();
  Laws laws(robot);
  std::vector<std::string> suspicious;
  const auto say = [&](const std::string& what) {
    suspicious.push_back(episode.name + ": " + what);
  };
  Means means = laws.means(episode, 0, episode.rows);
  for (const DeadColumn& dead : dead_columns(episode, robot, laws))
    say(words.of(dead)), means.forget(dead.column);
  for (const std::size_t j : beyond_their_stops(episode, joints)) {
    say(far_beyond(joints[j], episode.joints[j].angle_rad));
    means.scale({Quantity::angle, j}, std::numbers::pi / 180);
  }
  laws.find_paths(means);
  const auto mended = corrections(robot, laws, std::move(means));
  for (const Either& either : mended) say(words.of(either));
  for (const AtLimit& at : at_limit(episode, robot))
    if (!corrects(mended, at.column)) say(words.of(at));
  return suspicious;
}

}  // namespace sim::checks

#include "launch/erp/gap/messages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/gap/estimation/as_built.hpp"

namespace launch::gap {
namespace {

using sim::diagnosis::IdentifiedEffect;

constexpr double barely = 1.5;  // times the noise: more than that; chosen
constexpr double plain = 2;     // a gap
constexpr double rest = 3;      // and what is left of one

/// A stage that was at its floor and is not any more.
std::string opened_doubt(const sim::diagnosis::Diagnosis& d) {
  for (const auto& u : d.unexplained) {
    const auto before = sim::diagnosis::find_stage(d.stages, u.stage, u.on);
    if (before != d.stages.end() && before->judged && !before->open)
      return fmt::format(
          "the answer opens a gap at the {} of {}, which was at its noise: it may not be the "
          "cause; "
          "record other motions",
          sim::effects::word(u.stage), u.on);
  }
  return "";
}

/// A low-pass of a sensor in the answer, or among what could stand for it.
std::string late_column_doubt(const IdentifiedEffect& n) {
  if (n.type.ends_with("_low_pass"))
    return fmt::format(
        "a column delayed by {:.3g} ms would look like this {} on {}: check its times",
        1e3 * n.values[0], n.type, n.on);
  for (const IdentifiedEffect& other : n.alternatives)
    if (other.type.ends_with("_low_pass"))
      return fmt::format(
          "a column of {} that is some ms behind the others would look like this {}: "
          "check its times",
          other.on, n.type);
  return "";
}

/// How much the torque and back-EMF constants of the motors are off, by the answer or as constants.
std::vector<double> magnets_off(const sim::diagnosis::Diagnosis& d) {
  std::vector<double> off;
  for (const IdentifiedEffect& n : d.answer)
    if (n.type == "motor_torque_constant") off.push_back(n.values[0]);
  if (off.empty())
    for (const auto& c : d.constants)
      if (c.name == "torque_Nm_per_A" && c.differs()) off.push_back(c.value / c.nominal - 1);
  return off;
}

/// What columns would look like this answer: one behind the others, a time or voltages that are scaled.
std::string column_doubt(const sim::diagnosis::Diagnosis& d, const erp::Robot& robot) {
  for (const IdentifiedEffect& n : d.answer)
    if (const std::string doubt = late_column_doubt(n); !doubt.empty()) return doubt;
  constexpr double differs = 0.2;  // of the largest: motors are not off by the same; chosen
  const std::vector<double> off = magnets_off(d);
  if (off.size() < 2 || off.size() < robot.actuators.size()) return "";
  const auto [low, high] = std::ranges::minmax(off);
  const double widest = std::max(std::abs(low), std::abs(high));
  if (high - low > differs * widest) return "";
  return fmt::format(
      "the same on every motor: time_s running {:.2g} % too {}, or voltages recorded that much too "
      "{}, would look the same; check both",
      100 * widest, high > 0 ? "fast" : "slowly", high > 0 ? "high" : "low");
}

}  // namespace

std::string closed_words(const sim::diagnosis::Closed& c) {
  if (c.before <= c.floor && c.after <= plain * c.floor) return "no more than noise";
  if (c.after > c.before) return fmt::format("{:.1f} times as large", c.after / c.before);
  return fmt::format("{:.1f} % closed", 100 * std::min(1.0, c.closed));
}

std::string closed_interval(const sim::diagnosis::Closed& c) {
  if (c.before <= c.floor || c.after > c.before) return "";
  return fmt::format(" ({:.1f} … {:.1f} %)", 100 * std::min(1.0, c.interval.low),
                     100 * std::min(1.0, c.interval.high));
}

std::string judged_on(const sim::diagnosis::Diagnosis& d) {
  if (!d.uses_held_out_data()) return "the data it was found on";
  const bool only_rests = std::ranges::all_of(d.held_out, [&](const std::string& name) {
    return std::ranges::count(d.shared, name, &sim::diagnosis::Shared::recording) > 0;
  });
  return only_rests ? "the rest of the recording" : "held-out recordings";
}

std::string taken_as_it_is(const IdentifiedEffect& n) {
  std::string text;
  sim::effects::AnyEffect effect = n.placed.effect;
  for (const sim::effects::Parameter& p : sim::effects::parameters(effect))
    if (!p.fitted) text += fmt::format("; {} = {:g}, not fitted", p.name, *p.value);
  return text;
}

bool is_off(const sim::diagnosis::ConstantEstimate& c) {
  constexpr double least = 0.5;  // tolerances; chosen
  return c.determined > sim::estimation::well_determined &&
         (c.interval.low > c.nominal || c.interval.high < c.nominal) &&
         std::abs(c.value - c.nominal) > least * c.tolerance;
}

std::string share_words(double share) {
  return share < 0.005 ? "under 1 %" : fmt::format("{:.0f} %", 100 * share);
}

std::string zero_doubt(const std::vector<sim::diagnosis::IdentifiedEffect>& answer,
                       const erp::Robot& robot) {
  auto offset = *sim::effects::neutral("sensor_shaft_offset");
  const double widest_rad = sim::effects::parameters(offset)[0].bounds.high;
  for (const auto& n : answer) {
    if (n.type != "tendon_length_offset") continue;
    const auto actuator = std::ranges::find(robot.actuators, n.on, &erp::Actuator::name);
    const double zero_rad = -n.values[0] / actuator->spindle.radius_m;
    if (std::abs(zero_rad) > widest_rad)
      return fmt::format(
          "{}.shaft_rad: a zero that is {:.3g} rad off would look the same as this "
          "tendon_length_offset: "
          "if the encoder was not zeroed at the robot's initial pose, add {:.4g} to the column",
          n.on, zero_rad, -zero_rad);
  }
  return "";
}

std::string free_run_doubt(const sim::diagnosis::Diagnosis& d, const sim::diagnosis::Closed& c) {
  constexpr double enough = 0.5;  // closed; chosen
  if (d.verdict == sim::diagnosis::Verdict::no_gap)
    return c.before <= barely * c.floor
               ? ""
               : fmt::format(
                     "no stage has a gap, but the free run is off by {:.3g} times the noise: a "
                     "small error "
                     "adds up that these motions hardly show; record stronger and faster ones",
                     c.before);
  if (c.closed >= enough && c.after > rest * c.floor)
    return fmt::format(
        "the free run with them is still off by {:.3g} times the noise: a small error is left that "
        "these motions hardly show; record others",
        c.after);
  if (std::max(c.before, c.after) <= plain * c.floor || c.closed >= enough) return "";
  return fmt::format(
      "the free run is off by {:.3g} times the noise, with the effects by {:.3g}: they may not be "
      "the cause; record other motions",
      c.before, c.after);
}

std::vector<std::string> doubts(const sim::diagnosis::Diagnosis& d,
                                const sim::diagnosis::Closed& free_run, const erp::Robot& robot) {
  std::vector<std::string> all{free_run_doubt(d, free_run)};
  if (d.verdict == sim::diagnosis::Verdict::supported)
    for (std::string& doubt :
         std::vector{opened_doubt(d), zero_doubt(d.answer, robot), column_doubt(d, robot)})
      all.push_back(std::move(doubt));
  std::erase(all, "");
  return all;
}

}  // namespace launch::gap

#include "launch/erp/gap/messages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/gap/estimation/as_built.hpp"

namespace launch::gap {
namespace {

using sim::diagnosis::IdentifiedEffect;

// Limits of the free-run error, in units of the noise; chosen.
constexpr double no_gap_limit = 1.5;   // warn above it if the residuals have no gap
constexpr double gap_limit = 2;        // above it, the free run has a gap
constexpr double remaining_limit = 3;  // warn above it if the identified effects close the gap

/// Warning if the answer raises the residual of a stage above its noise floor.
std::string opened_stage_warning(const sim::diagnosis::Diagnosis& d) {
  for (const auto& u : d.unexplained) {
    const auto stage = sim::diagnosis::find_stage(d.stages, u.stage, u.on);
    if (stage != d.stages.end() && stage->judged && !stage->open)
      return fmt::format(
          "the answer opens a gap at the {} of {}, whose residual was within its noise: the answer "
          "may not be the cause; record other motions",
          sim::effects::word(u.stage), u.on);
  }
  return "";
}

/// Warning if a low-pass of a sensor is in the answer or equivalent to it.
std::string delayed_column_warning(const IdentifiedEffect& n) {
  if (n.type.ends_with("_low_pass"))
    return fmt::format(
        "a column delayed by {:.3g} ms causes the same residuals as this {} on {}; check the times "
        "of the column",
        1e3 * n.values[0], n.type, n.on);
  for (const IdentifiedEffect& other : n.alternatives)
    if (other.type.ends_with("_low_pass"))
      return fmt::format(
          "a column of {} that is some ms behind the others causes the same residuals as this {}; "
          "check the times of the column",
          other.on, n.type);
  return "";
}

/// Relative deviations of the motors' torque constants: from the answer, otherwise from the
/// estimated constants.
std::vector<double> torque_constant_deviations(const sim::diagnosis::Diagnosis& d) {
  std::vector<double> deviations;
  for (const IdentifiedEffect& n : d.answer)
    if (n.type == "motor_torque_constant") deviations.push_back(n.values[0]);
  if (deviations.empty())
    for (const auto& c : d.constants)
      if (c.name == "torque_Nm_per_A" && c.differs()) deviations.push_back(c.value / c.nominal - 1);
  return deviations;
}

/// Warning if a delayed column, a scaled time column or scaled voltages cause the same residuals as
/// the answer.
std::string column_warning(const sim::diagnosis::Diagnosis& d, const erp::Robot& robot) {
  for (const IdentifiedEffect& n : d.answer)
    if (const std::string warning = delayed_column_warning(n); !warning.empty()) return warning;
  // Relative to the largest deviation. Above it, the motors do not deviate by the same factor.
  // Chosen.
  constexpr double max_spread = 0.2;
  const std::vector<double> deviations = torque_constant_deviations(d);
  if (deviations.size() < 2 || deviations.size() < robot.actuators.size()) return "";
  const auto [low, high] = std::ranges::minmax(deviations);
  const double largest = std::max(std::abs(low), std::abs(high));
  if (high - low > max_spread * largest) return "";
  return fmt::format(
      "every motor deviates by the same share: time_s running {:.2g} % too {}, or voltages "
      "recorded that much too {}, cause the same residuals; check both",
      100 * largest, high > 0 ? "fast" : "slowly", high > 0 ? "high" : "low");
}

}  // namespace

std::string closure_text(const sim::diagnosis::ClosedGap& c) {
  if (c.before <= c.floor && c.after <= gap_limit * c.floor) return "within the noise";
  if (c.after > c.before) return fmt::format("{:.1f} times as large", c.after / c.before);
  return fmt::format("{:.1f} % closed", 100 * std::min(1.0, c.closed));
}

std::string closure_interval(const sim::diagnosis::ClosedGap& c) {
  if (c.before <= c.floor || c.after > c.before) return "";
  return fmt::format(" ({:.1f} … {:.1f} %)", 100 * std::min(1.0, c.interval.low),
                     100 * std::min(1.0, c.interval.high));
}

std::string validation_data(const sim::diagnosis::Diagnosis& d) {
  if (!d.uses_held_out_data()) return "the training data";
  const bool only_parts = std::ranges::all_of(d.held_out, [&](const std::string& name) {
    return std::ranges::count(d.split_recordings, name,
                              &sim::diagnosis::SplitRecording::recording) > 0;
  });
  return only_parts ? "the rest of the recording" : "held-out recordings";
}

std::string fixed_parameters(const IdentifiedEffect& n) {
  std::string text;
  sim::effects::AnyEffect effect = n.placed.effect;
  for (const sim::effects::Parameter& p : sim::effects::parameters(effect))
    if (!p.fitted) text += fmt::format("; {} = {:g}, not fitted", p.name, *p.value);
  return text;
}

bool deviates(const sim::diagnosis::ConstantEstimate& c) {
  constexpr double min_deviation = 0.5;  // tolerances; smallest reported deviation; chosen
  return c.determined > sim::estimation::determined_threshold &&
         (c.interval.low > c.nominal || c.interval.high < c.nominal) &&
         std::abs(c.value - c.nominal) > min_deviation * c.tolerance;
}

std::string share_text(double share) {
  return share < 0.005 ? "under 1 %" : fmt::format("{:.0f} %", 100 * share);
}

std::string zero_offset_warning(const std::vector<sim::diagnosis::IdentifiedEffect>& answer,
                                const erp::Robot& robot) {
  auto offset = *sim::effects::neutral("sensor_shaft_offset");
  const double max_offset_rad = sim::effects::parameters(offset)[0].bounds.high;
  for (const auto& n : answer) {
    if (n.type != "tendon_length_offset") continue;
    const auto actuator = std::ranges::find(robot.actuators, n.on, &erp::Actuator::name);
    const double zero_rad = -n.values[0] / actuator->spindle.radius_m;
    if (std::abs(zero_rad) > max_offset_rad)
      return fmt::format(
          "{}.shaft_rad: a zero that is {:.3g} rad off causes the same residuals as this "
          "tendon_length_offset; if the encoder was not zeroed at the robot's initial pose, add "
          "{:.4g} to the column",
          n.on, zero_rad, -zero_rad);
  }
  return "";
}

std::string free_run_warning(const sim::diagnosis::Diagnosis& d,
                             const sim::diagnosis::ClosedGap& c) {
  constexpr double min_closure = 0.5;  // gap closure; chosen
  if (d.verdict == sim::diagnosis::Verdict::no_gap)
    return c.before <= no_gap_limit * c.floor
               ? ""
               : fmt::format(
                     "no stage has a gap, but the free-run error is {:.3g} times the noise: a "
                     "small model error accumulates that these motions hardly excite; record "
                     "stronger and faster motions",
                     c.before);
  if (c.closed >= min_closure && c.after > remaining_limit * c.floor)
    return fmt::format(
        "with the identified effects the free-run error is still {:.3g} times the noise: a small "
        "model error remains that these motions hardly excite; record other motions",
        c.after);
  if (std::max(c.before, c.after) <= gap_limit * c.floor || c.closed >= min_closure) return "";
  return fmt::format(
      "the free-run error is {:.3g} times the noise, with the identified effects {:.3g} times: "
      "these effects may not be the cause; record other motions",
      c.before, c.after);
}

std::vector<std::string> answer_warnings(const sim::diagnosis::Diagnosis& d,
                                         const sim::diagnosis::ClosedGap& free_run,
                                         const erp::Robot& robot) {
  std::vector<std::string> warnings{free_run_warning(d, free_run)};
  if (d.verdict == sim::diagnosis::Verdict::supported)
    for (std::string& warning :
         std::vector{opened_stage_warning(d), zero_offset_warning(d.answer, robot),
                     column_warning(d, robot)})
      warnings.push_back(std::move(warning));
  std::erase(warnings, "");
  return warnings;
}

}  // namespace launch::gap

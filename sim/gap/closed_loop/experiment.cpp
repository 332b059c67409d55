#include "sim/gap/closed_loop/experiment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "interfaces/parallel/in_parallel.hpp"
#include "sim/gap/closed_loop/predicted_run.hpp"

namespace sim::closed_loop {
namespace {

using diagnosis::Evaluator;
using effects::Placed;

erp::Robot with(const erp::Robot& robot, const Placed& placed) {
  erp::Robot changed = robot;
  changed.effects.push_back(effects::written(placed));
  return changed;
}

/// Fraction of the time in which a motor is at the supply voltage.
double saturated_fraction(const recording::Table& table, const erp::Robot& robot,
                          const erp::Actuator& actuator) {
  const auto& volts = table.find(actuator.name + ".voltage_V")->values;
  constexpr double near_supply = 0.99;  // chosen
  const double limit_V = near_supply * robot.motor_of(actuator).supply_V;
  const auto saturated_rows =
      std::ranges::count_if(volts, [&](double v) { return std::abs(v) >= limit_V; });
  return volts.empty() ? 0 : double(saturated_rows) / double(volts.size());
}

Extremes extremes_of(const recording::Table& table, const erp::Robot& robot) {
  Extremes e;
  e.stop_distance_rad = std::numeric_limits<double>::infinity();
  for (const erp::Actuator& actuator : robot.actuators)
    for (const double tension : table.find(actuator.name + ".tension_N")->values)
      if (const double fraction = tension / actuator.max_tension_N; fraction > e.tension_fraction)
        e.tension_fraction = fraction, e.tension_actuator = actuator.name;
  for (const erp::Actuator& actuator : robot.actuators)
    if (const double fraction = saturated_fraction(table, robot, actuator);
        fraction > e.saturated_fraction)
      e.saturated_fraction = fraction, e.saturated_actuator = actuator.name;
  for (const erp::Joint& joint : robot.joints())
    if (const auto* angle = table.find(joint.name + ".angle_rad"))
      for (const double q : angle->values)
        if (const double distance = std::min(q - joint.min_rad, joint.max_rad - q);
            distance < e.stop_distance_rad)
          e.stop_distance_rad = distance, e.stop_joint = joint.name;
  return e;
}

/// Extends the extremes by those of another run.
void extend(const Extremes& a, Extremes& extremes) {
  if (a.tension_fraction > extremes.tension_fraction)
    extremes.tension_fraction = a.tension_fraction, extremes.tension_actuator = a.tension_actuator;
  if (a.saturated_fraction > extremes.saturated_fraction)
    extremes.saturated_fraction = a.saturated_fraction,
    extremes.saturated_actuator = a.saturated_actuator;
  if (a.stop_distance_rad < extremes.stop_distance_rad)
    extremes.stop_distance_rad = a.stop_distance_rad, extremes.stop_joint = a.stop_joint;
}

/// Reason why a run is not safe; empty: safe.
std::string danger(const Extremes& e, const ExperimentOptions& options) {
  if (e.tension_fraction > options.tension_fraction)
    return fmt::format("tension of {} reaches {:.0f} % of its limit", e.tension_actuator,
                       100 * e.tension_fraction);
  if (e.stop_distance_rad <= 0) return e.stop_joint + " reaches its stop";
  if (e.stop_distance_rad <= options.stop_distance_rad)
    return fmt::format("{} comes within {:.3f} rad of its stop", e.stop_joint, e.stop_distance_rad);
  return "";
}

/// Σ z² of a suspect, fitted to the predicted run.
double square_of(const Evaluator& evaluator, const Placed& suspect) {
  const std::size_t only[] = {0};
  return diagnosis::fit(evaluator, evaluator.nominal_evaluation(), suspect, only).square;
}

/// An excitation that starts at rest: at pretension, with shafts at 0.
Excitation from_rest(const erp::Robot& robot, int kind, double duration_s, std::uint64_t seed) {
  constexpr double ramp_s = 1;  // chosen
  Excitation ramped = excitation(robot, kind, duration_s, seed);
  const auto rows = std::min(ramped.reference.size(), std::size_t(ramp_s / ramped.period_s));
  for (std::size_t k = 0; k < rows; ++k)
    for (std::size_t a = 0; a < ramped.reference[k].size(); ++a) {
      const double rest =
          ramped.mode == erp::Mode::force ? robot.actuators[a].tendon.pretension_N : 0.0;
      double& reference = ramped.reference[k][a];
      reference = std::lerp(rest, reference, double(k) / double(rows));
    }
  return ramped;
}

double split(double other, double first) { return std::sqrt(std::max(0.0, other - first)); }

Candidate evaluate(const erp::Robot& robot, const std::vector<Placed>& suspects, int kind,
                   std::uint64_t seed, const ExperimentOptions& options) {
  Candidate candidate{kind, seed};
  const SetPoints set_points = set_points_of(from_rest(robot, kind, options.seconds, seed));
  candidate.extremes = extremes_of(predict_run(robot, set_points, seed), robot);
  recording::Table truth;
  for (const Placed& suspect : suspects) {
    const auto table = predict_run(with(robot, suspect), set_points, seed);
    extend(extremes_of(table, robot), candidate.extremes);
    if (&suspect == &suspects.front()) truth = table;
  }
  candidate.unsafe = danger(candidate.extremes, options);
  if (!candidate.unsafe.empty()) return candidate;
  std::vector<std::string> remarks;
  const Evaluator evaluator(robot, {residuals::lay_out(truth, robot, "predicted run", remarks)});
  const std::size_t only[] = {0};
  const double first = square_of(evaluator, suspects[0]);
  for (std::size_t k = 1; k < suspects.size(); ++k)
    candidate.split.push_back(split(square_of(evaluator, suspects[k]), first));
  if (suspects.size() == 1)
    candidate.split = {
        split(sum(evaluator.blocks(evaluator.nominal_evaluation(), only)).square, first)};
  candidate.least_split = *std::ranges::min_element(candidate.split);
  return candidate;
}

}  // namespace

Experiment next_experiment(const erp::Robot& robot, const std::vector<Placed>& suspects,
                           const ExperimentOptions& options) {
  if (suspects.empty()) throw std::invalid_argument("no suspect: name at least one effect");
  Experiment experiment;
  experiment.candidates.resize(static_cast<std::size_t>(options.candidates));
  std::atomic<int> evaluated = 0;
  in_parallel(experiment.candidates.size(), options.threads, [&](std::size_t k) {
    const std::uint64_t seed = options.seed + k / excitation_kinds;
    experiment.candidates[k] =
        evaluate(robot, suspects, static_cast<int>(k % excitation_kinds), seed, options);
    if (options.progress) options.progress(double(++evaluated) / options.candidates);
  });
  std::ranges::stable_sort(experiment.candidates, [](const Candidate& a, const Candidate& b) {
    return std::pair(!a.unsafe.empty(), -a.least_split) <
           std::pair(!b.unsafe.empty(), -b.least_split);
  });
  const Candidate& best = experiment.candidates.front();
  if (best.unsafe.empty())
    experiment.chosen = from_rest(robot, best.kind, options.seconds, best.seed);
  return experiment;
}

}  // namespace sim::closed_loop

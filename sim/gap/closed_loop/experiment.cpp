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

/// Share of the time in which a motor is at the supply voltage.
double saturated(const recording::Table& table, const erp::Robot& robot,
                 const erp::Actuator& actuator) {
  const auto& volts = table.find(actuator.name + ".voltage_V")->values;
  const double most_V = 0.99 * robot.motor_of(actuator).supply_V;
  const auto at_most =
      std::ranges::count_if(volts, [&](double v) { return std::abs(v) >= most_V; });
  return volts.empty() ? 0 : double(at_most) / double(volts.size());
}

Extremes extremes_of(const recording::Table& table, const erp::Robot& robot) {
  Extremes e;
  e.to_stop_rad = std::numeric_limits<double>::infinity();
  for (const erp::Actuator& actuator : robot.actuators)
    for (const double tension : table.find(actuator.name + ".tension_N")->values)
      if (const double share = tension / actuator.max_tension_N; share > e.of_max_tension)
        e.of_max_tension = share, e.tightest = actuator.name;
  for (const erp::Actuator& actuator : robot.actuators)
    if (const double share = saturated(table, robot, actuator); share > e.saturated)
      e.saturated = share, e.slowest = actuator.name;
  for (const erp::Joint& joint : robot.joints())
    if (const auto* angle = table.find(joint.name + ".angle_rad"))
      for (const double q : angle->values)
        if (const double left = std::min(q - joint.min_rad, joint.max_rad - q);
            left < e.to_stop_rad)
          e.to_stop_rad = left, e.nearest = joint.name;
  return e;
}

void worse_of(const Extremes& a, Extremes& into) {
  if (a.of_max_tension > into.of_max_tension)
    into.of_max_tension = a.of_max_tension, into.tightest = a.tightest;
  if (a.saturated > into.saturated) into.saturated = a.saturated, into.slowest = a.slowest;
  if (a.to_stop_rad < into.to_stop_rad) into.to_stop_rad = a.to_stop_rad, into.nearest = a.nearest;
}

/// Reason why a run is not safe; empty: it is safe.
std::string danger(const Extremes& e, const ExperimentOptions& options) {
  if (e.of_max_tension > options.of_max_tension)
    return fmt::format("tension of {} reaches {:.0f} % of its limit", e.tightest,
                       100 * e.of_max_tension);
  if (e.to_stop_rad <= 0) return e.nearest + " reaches its stop";
  if (e.to_stop_rad <= options.to_stop_rad)
    return fmt::format("{} comes within {:.3f} rad of its stop", e.nearest, e.to_stop_rad);
  return "";
}

/// Σ z² of a suspect, fitted to the predicted run.
double square_of(const Evaluator& evaluator, const Placed& suspect) {
  const std::size_t only[] = {0};
  return diagnosis::fit(evaluator, evaluator.bare(), suspect, only).square;
}

/// An excitation that starts at rest: at pretension, with no line wound.
Excitation from_rest(const erp::Robot& robot, int kind, double duration_s, std::uint64_t seed) {
  constexpr double ramp_s = 1;
  Excitation all = excitation(robot, kind, duration_s, seed);
  const auto rows = std::min(all.reference.size(), std::size_t(ramp_s / all.period_s));
  for (std::size_t k = 0; k < rows; ++k)
    for (std::size_t a = 0; a < all.reference[k].size(); ++a) {
      const double rest =
          all.mode == erp::Mode::force ? robot.actuators[a].tendon.pretension_N : 0.0;
      double& reference = all.reference[k][a];
      reference = std::lerp(rest, reference, double(k) / double(rows));
    }
  return all;
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
    worse_of(extremes_of(table, robot), candidate.extremes);
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
    candidate.split = {split(sum(evaluator.blocks(evaluator.bare(), only)).square, first)};
  candidate.least = *std::ranges::min_element(candidate.split);
  return candidate;
}

}  // namespace

Experiment next_experiment(const erp::Robot& robot, const std::vector<Placed>& suspects,
                           const ExperimentOptions& options) {
  if (suspects.empty()) throw std::invalid_argument("no suspect: name at least one effect");
  Experiment experiment;
  experiment.candidates.resize(static_cast<std::size_t>(options.candidates));
  std::atomic<int> done = 0;
  in_parallel(experiment.candidates.size(), options.threads, [&](std::size_t k) {
    const std::uint64_t seed = options.seed + k / excitation_kinds;
    experiment.candidates[k] =
        evaluate(robot, suspects, static_cast<int>(k % excitation_kinds), seed, options);
    if (options.progress) options.progress(double(++done) / options.candidates);
  });
  std::ranges::stable_sort(experiment.candidates, [](const Candidate& a, const Candidate& b) {
    return std::pair(!a.unsafe.empty(), -a.least) < std::pair(!b.unsafe.empty(), -b.least);
  });
  const Candidate& best = experiment.candidates.front();
  if (best.unsafe.empty())
    experiment.chosen = from_rest(robot, best.kind, options.seconds, best.seed);
  return experiment;
}

}  // namespace sim::closed_loop

#include "sim/gap/diagnosis/direct_detection.hpp"

#include <algorithm>
#include <cmath>

#include "sim/gap/diagnosis/quantization_step.hpp"

namespace sim::diagnosis {
namespace {

/// Adds bus effects that were detected from the timing of the rows (sim/gap/estimation/row_timing,
/// defective_rows). A delay of commands and a delay of sensors are indistinguishable.
void add_rows(const Problem& problem, Detected& detected) {
  const residuals::Episode& first = problem.episodes[0];  // these values are equal in all episodes
  const auto add = [&](const char* type, double value, double half_width) {
    if (value == 0 || std::ranges::count(problem.options.withhold, type)) return;
    effects::Placed placed{problem.robot.name, *effects::neutral(type)};
    *effects::parameters(placed.effect)[0].value = value;
    IdentifiedEffect n = identified(placed);
    n.intervals[0] = {value - half_width, value + half_width};
    n.gain = 1, n.gain_interval = {1, 1}, n.supported = true;
    detected.bus.push_back(std::move(n));
    detected.bus_evaluated = true;
  };
  constexpr double relative_half_width = 0.1;  // of an interval; chosen
  add("bus_frame_loss", first.repeated_fraction, relative_half_width * first.repeated_fraction);
  add("bus_command_delay", first.voltage_delay_s, first.period_s / 2);
  add("bus_sensor_delay", first.voltage_delay_s, first.period_s / 2);
  add("bus_jitter", first.jitter_s, relative_half_width * first.jitter_s);
}

void detect_bus_effects(const Problem& problem, Detected& detected) {
  const auto ages = [&](const std::vector<std::size_t>& set) {
    std::vector<Ages> all;
    for (const std::size_t e : set) all.push_back(command_ages(problem.episodes[e], problem.robot));
    return all;
  };
  const auto held_out = ages(problem.sets.held_out);
  const auto train = ages(problem.sets.train);
  detected.bus_evaluated = has_enough_ages(train) && has_enough_ages(held_out);
  detected.delayed_fraction = delayed_fraction(held_out);
  for (const BusFit& fit : fit_bus(train, held_out, problem.robot, problem.options.withhold))
    detected.bus.push_back(identified(fit));
}

/// Σ z² of `evaluator` with its larger noise floor, over windows that both evaluators can evaluate.
double square_of(const Evaluator& evaluator, const Evaluator& baseline,
                 const std::vector<std::size_t>& set) {
  double square = 0;
  for (const std::size_t e : set) {
    const auto baseline_z = baseline.whitened(baseline.nominal_evaluation(), e),
               coarse_z = evaluator.whitened(evaluator.nominal_evaluation(), e);
    for (std::size_t k = 0; k < baseline_z.size(); ++k)
      if (!std::isnan(baseline_z[k]) && !std::isnan(coarse_z[k]))
        square += coarse_z[k] * coarse_z[k];
  }
  return square;
}

void detect_steps(const Problem& problem, const Evaluator& baseline, Detected& detected) {
  constexpr double relative_half_width = 0.05;  // of an interval, because converters round; chosen
  const auto before = sum(baseline.blocks(baseline.nominal_evaluation(), problem.sets.held_out));
  const auto windows = static_cast<double>(before.windows);
  for (const effects::Placed& placed : coarse_sensors(problem.episodes, problem.robot)) {
    if (std::ranges::count(problem.options.withhold, effects::about(placed.effect).type)) continue;
    erp::Robot coarse = problem.robot;
    coarse.effects.push_back(effects::written(placed));
    const double after = square_of(Evaluator(coarse, problem.episodes, problem.options.seed),
                                   baseline, problem.sets.held_out);
    IdentifiedEffect n = identified(placed);
    n.intervals[0] = {(1 - relative_half_width) * n.values[0],
                      (1 + relative_half_width) * n.values[0]};
    n.gain = (before.square - std::max(after, windows)) / std::max(before.square - windows, 1e-9);
    n.gain_interval = {n.gain, n.gain};
    n.supported = true;
    detected.sensors.push_back(n);
  }
}

}  // namespace

Detected detect_directly(const Problem& problem, const Evaluator& baseline) {
  Detected detected;
  add_rows(problem, detected);
  if (!detected.bus_differs()) detect_bus_effects(problem, detected);
  detect_steps(problem, baseline, detected);
  return detected;
}

}  // namespace sim::diagnosis

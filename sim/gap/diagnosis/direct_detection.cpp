#include "sim/gap/diagnosis/direct_detection.hpp"

#include <algorithm>
#include <cmath>

#include "sim/gap/diagnosis/quantization_step.hpp"

namespace sim::diagnosis {
namespace {

/// Bus effects detected from the timing of the rows (sim/gap/estimation/row_timing, defective_rows). `half`: half width of
/// the interval. A delay of commands and one of sensors are indistinguishable.
void add_rows(const Problem& problem, Detected& detected) {
  const residuals::Episode& any = problem.episodes[0];
  const auto add = [&](const char* type, double value, double half) {
    if (value == 0 || std::ranges::count(problem.options.withhold, type)) return;
    effects::Placed placed{problem.robot.name, *effects::neutral(type)};
    *effects::parameters(placed.effect)[0].value = value;
    IdentifiedEffect n = identified(placed);
    n.intervals[0] = {value - half, value + half};
    n.gain = 1, n.gain_interval = {1, 1}, n.supported = true;
    detected.bus.push_back(std::move(n));
    detected.bus_evaluated = true;
  };
  constexpr double of_share = 0.1, of_spread = 0.1;  // of the value; chosen
  add("bus_frame_loss", any.repeated_share, of_share * any.repeated_share);
  add("bus_command_delay", any.voltage_late_s, any.period_s / 2);
  add("bus_sensor_delay", any.voltage_late_s, any.period_s / 2);
  add("bus_jitter", any.jitter_s, of_spread * any.jitter_s);
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
  detected.late = late_share(held_out);
  for (const BusFit& fit : fit_bus(train, held_out, problem.robot, problem.options.withhold))
    detected.bus.push_back(identified(fit));
}

/// Σ z² of `evaluator` with its own, larger noise floor, over windows that both can evaluate.
double square_of(const Evaluator& evaluator, const Evaluator& plain,
                 const std::vector<std::size_t>& set) {
  double square = 0;
  for (const std::size_t e : set) {
    const auto old = plain.whitened(plain.bare(), e), now = evaluator.whitened(evaluator.bare(), e);
    for (std::size_t k = 0; k < old.size(); ++k)
      if (!std::isnan(old[k]) && !std::isnan(now[k])) square += now[k] * now[k];
  }
  return square;
}

void detect_steps(const Problem& problem, const Evaluator& plain, Detected& detected) {
  constexpr double of_step = 0.05;  // half width of the interval, because converters round; chosen
  const auto before = sum(plain.blocks(plain.bare(), problem.sets.held_out));
  const auto windows = static_cast<double>(before.windows);
  for (const effects::Placed& placed : coarse_sensors(problem.episodes, problem.robot)) {
    if (std::ranges::count(problem.options.withhold, effects::about(placed.effect).type)) continue;
    erp::Robot coarse = problem.robot;
    coarse.effects.push_back(effects::written(placed));
    const double after = square_of(Evaluator(coarse, problem.episodes, problem.options.seed), plain,
                                   problem.sets.held_out);
    IdentifiedEffect n = identified(placed);
    n.intervals[0] = {(1 - of_step) * n.values[0], (1 + of_step) * n.values[0]};
    n.gain = (before.square - std::max(after, windows)) / std::max(before.square - windows, 1e-9);
    n.gain_interval = {n.gain, n.gain};
    n.supported = true;
    detected.sensors.push_back(n);
  }
}

}  // namespace

Detected detect_directly(const Problem& problem, const Evaluator& plain) {
  Detected detected;
  add_rows(problem, detected);
  if (!detected.bus_differs()) detect_bus_effects(problem, detected);
  detect_steps(problem, plain, detected);
  return detected;
}

}  // namespace sim::diagnosis

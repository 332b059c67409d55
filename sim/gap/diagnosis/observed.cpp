#include "sim/gap/diagnosis/observed.hpp"

#include <algorithm>
#include <cmath>

#include "sim/gap/diagnosis/lattice.hpp"

namespace sim::diagnosis {
namespace {

/// What the rows themselves show of the bus (sim/gap/estimation/row_timing, spoilt_rows): a value, and half of
/// its interval. A delay of commands and one of sensors are indistinguishable.
void add_rows(const Evidence& evidence, Observed& observed) {
  const residuals::Episode& any = evidence.episodes[0];
  const auto add = [&](const char* type, double value, double half) {
    if (value == 0 || std::ranges::count(evidence.options.withhold, type)) return;
    effects::Placed placed{evidence.robot.name, *effects::neutral(type)};
    *effects::parameters(placed.effect)[0].value = value;
    Named n = named(placed);
    n.intervals[0] = {value - half, value + half};
    n.gain = 1, n.gain_interval = {1, 1}, n.supported = true;
    observed.bus.push_back(std::move(n));
    observed.bus_told = true;
  };
  constexpr double of_share = 0.1, of_spread = 0.1;  // of the value; chosen
  add("bus_frame_loss", any.repeated_share, of_share * any.repeated_share);
  add("bus_command_delay", any.voltage_late_s, any.period_s / 2);
  add("bus_sensor_delay", any.voltage_late_s, any.period_s / 2);
  add("bus_jitter", any.jitter_s, of_spread * any.jitter_s);
}

void look_at_bus(const Evidence& evidence, Observed& observed) {
  const auto ages = [&](const std::vector<std::size_t>& set) {
    std::vector<Ages> all;
    for (const std::size_t e : set)
      all.push_back(command_ages(evidence.episodes[e], evidence.robot));
    return all;
  };
  const auto held_out = ages(evidence.sets.held_out);
  const auto train = ages(evidence.sets.train);
  observed.bus_told = told(train) && told(held_out);
  observed.late = late_share(held_out);
  for (const BusFit& fit : fit_bus(train, held_out, evidence.robot, evidence.options.withhold))
    observed.bus.push_back(named(fit));
}

/// Σ z² of trials with their own, larger noise, where both can judge.
double square_of(const Trials& trials, const Trials& plain, const std::vector<std::size_t>& set) {
  double square = 0;
  for (const std::size_t e : set) {
    const auto old = plain.whitened(plain.bare(), e), now = trials.whitened(trials.bare(), e);
    for (std::size_t k = 0; k < old.size(); ++k)
      if (!std::isnan(old[k]) && !std::isnan(now[k])) square += now[k] * now[k];
  }
  return square;
}

void look_at_steps(const Evidence& evidence, const Trials& plain, Observed& observed) {
  constexpr double of_step = 0.05;  // the interval's half width: converters round
  const auto before = sum(plain.blocks(plain.bare(), evidence.sets.held_out));
  const auto windows = static_cast<double>(before.windows);
  for (const effects::Placed& placed : coarse_sensors(evidence.episodes, evidence.robot)) {
    if (std::ranges::count(evidence.options.withhold, effects::about(placed.effect).type)) continue;
    erp::Robot coarse = evidence.robot;
    coarse.effects.push_back(effects::written(placed));
    const double after = square_of(Trials(coarse, evidence.episodes, evidence.options.seed), plain,
                                   evidence.sets.held_out);
    Named n = named(placed);
    n.intervals[0] = {(1 - of_step) * n.values[0], (1 + of_step) * n.values[0]};
    n.gain = (before.square - std::max(after, windows)) / std::max(before.square - windows, 1e-9);
    n.gain_interval = {n.gain, n.gain};
    n.supported = true;
    observed.sensors.push_back(n);
  }
}

}  // namespace

Observed observe(const Evidence& evidence, const Trials& plain) {
  Observed observed;
  add_rows(evidence, observed);
  if (!observed.bus_differs()) look_at_bus(evidence, observed);
  look_at_steps(evidence, plain, observed);
  return observed;
}

}  // namespace sim::diagnosis

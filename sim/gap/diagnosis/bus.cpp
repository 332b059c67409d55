#include "sim/gap/diagnosis/bus.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <random>

#include "firmware/core/ecu.h"
#include "interfaces/values.hpp"
#include "sim/control/gain_design.hpp"
#include "sim/model/actuator/sensors.hpp"
#include "sim/model/effects/acting.hpp"

namespace sim::diagnosis {
namespace {

constexpr std::size_t age_limit = 60;  // ticks; chosen
// Fraction of ages; below, the ECU has another law; chosen.
constexpr double least_determined = 0.6;
constexpr double near_limit = 0.97;         // of current or supply; chosen
constexpr std::size_t least_checked = 100;  // ticks; chosen

/// Law of one actuator: V = gain · reference + offset.
struct Law {
  double gain = 0;
  std::vector<double> offset_V;  ///< NaN: unknown
};

/// Law of the ECU firmware. `offset_V` is computed from the measurements of the previous row, by
/// mode.
Law law_of(const residuals::ActuatorSignals& s, const erp::Robot& robot,
           const erp::Actuator& actuator, double period_s) {
  Law law;
  if (s.mode.empty() || s.reference.empty() || s.voltage_V.empty() || s.shaft_rad.empty())
    return law;
  const auto first = std::ranges::find_if(s.mode, [](double m) { return !std::isnan(m); });
  if (first == s.mode.end()) return law;
  const auto mode = static_cast<erp::Mode>(std::lround(*first));
  const bool is_length = mode == erp::Mode::length;
  const bool is_force = mode == erp::Mode::force && !s.current_A.empty() && !s.tension_N.empty();
  if (!is_length && !is_force) return law;
  const auto gains = design_parameters(robot, actuator, {});
  const auto gain = [&](ecu_parameter_index k) {
    return static_cast<double>(gains[static_cast<std::size_t>(k)]);
  };
  law.gain = is_length ? -gain(ECU_PARAMETER_LENGTH_KP) / actuator.spindle.radius_m
                       : gain(ECU_PARAMETER_FORCE_PREFILTER);
  law.offset_V.assign(s.voltage_V.size(), recording::not_taken);
  for (std::size_t k = 2; k < s.voltage_V.size(); ++k) {
    if (s.mode[k] != *first) continue;
    const double speed = (s.shaft_rad[k - 1] - s.shaft_rad[k - 2]) / period_s;
    const double back_emf_V = gain(ECU_PARAMETER_BACK_EMF) * speed;
    const double current_limit_V =
        gain(ECU_PARAMETER_RESISTANCE) * gain(ECU_PARAMETER_CURRENT_LIMIT);
    const bool is_unlimited =
        std::abs(s.voltage_V[k] - back_emf_V) < near_limit * current_limit_V &&
        std::abs(s.voltage_V[k]) < near_limit * gain(ECU_PARAMETER_SUPPLY);
    if (!is_unlimited) continue;
    law.offset_V[k] = is_length ? -gain(ECU_PARAMETER_LENGTH_KP) * s.shaft_rad[k - 1]
                                : -(gain(ECU_PARAMETER_FORCE_K_CURRENT) * s.current_A[k - 1] +
                                    gain(ECU_PARAMETER_FORCE_K_SPEED) * speed +
                                    gain(ECU_PARAMETER_FORCE_K_TENSION) * s.tension_N[k - 1]);
  }
  return law;
}

void add_ages(const residuals::Episode& episode, const residuals::ActuatorSignals& s,
              const Law& law, double tolerance_V, Ages& ages) {
  for (std::size_t k = age_limit; k < law.offset_V.size(); ++k) {
    if (std::isnan(law.offset_V[k]) || !episode.judged(k)) continue;
    const auto predicted_V = [&](std::size_t age) {
      return law.gain * s.reference[k - age] + law.offset_V[k];
    };
    if (!(std::abs(predicted_V(0) - predicted_V(1)) > 3 * tolerance_V))
      continue;  // indistinguishable
    ++ages.checked;
    for (std::size_t age = 0; age < age_limit; ++age)
      if (std::abs(predicted_V(age) - s.voltage_V[k]) < tolerance_V) {
        ++ages.ticks[age], ++ages.determined;
        break;
      }
  }
}

/// Adds ages from the set-points that the ECU reports: the age of the only command with that
/// set-point.
void add_reported_ages(const residuals::Episode& episode, const residuals::ActuatorSignals& s,
                       Ages& ages) {
  for (std::size_t k = age_limit; k < s.sent.size(); ++k) {
    if (!episode.judged(k) || !(std::abs(s.sent[k] - s.sent[k - 1]) > 0))
      continue;  // indistinguishable
    std::vector<std::size_t> matches;
    for (std::size_t age = 0; age < age_limit; ++age)
      if (s.sent[k - age] == s.followed[k]) matches.push_back(age);
    if (matches.size() > 1) continue;  // the same set-point was sent several times
    ++ages.checked;
    if (matches.size() == 1) ++ages.ticks[matches[0]], ++ages.determined;
  }
}

/// Predicted frequency of each age with an effect. Commands are sent every tick and received in
/// order.
std::vector<double> predicted_ages(const effects::Placed& placed, double period_s) {
  constexpr int ticks = 4000, settling_ticks = 200;  // chosen
  effects::Acting acting(std::span(&placed, 1), placed.on, effects::Seat::robot);
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  const auto draw = [&] { return uniform(random); };
  std::deque<std::pair<double, int>> queue;
  std::vector<double> frequency(age_limit, 0.0);
  int received = 0;
  for (int k = 0; k < ticks; ++k) {
    const double now_s = k * period_s;
    const double delay_s = acting.command_delay_s(draw) + acting.frame_delay_s(draw);
    if (!acting.loses_command(draw)) {
      const double due_s = now_s + delay_s;
      queue.emplace_back(queue.empty() ? due_s : std::max(due_s, queue.back().first), k);
    }
    while (!queue.empty() && queue.front().first <= now_s + 1e-9)
      received = queue.front().second, queue.pop_front();
    if (k > settling_ticks)
      frequency[std::min<std::size_t>(age_limit - 1, std::size_t(k - received))] += 1;
  }
  constexpr double stray = 0.002;  // fraction of wrong ages; chosen
  for (double& s : frequency)
    s = (1 - stray) * s / (ticks - settling_ticks - 1) + stray / age_limit;
  return frequency;
}

double likelihood(std::span<const Ages> ages, const std::vector<double>& frequency) {
  double sum = 0;
  for (const Ages& one : ages)
    for (std::size_t a = 0; a < age_limit; ++a)
      sum += static_cast<double>(one.ticks[a]) * std::log(frequency[a]);
  return sum;
}

/// Observed frequency of each age.
std::vector<double> observed_ages(std::span<const Ages> ages) {
  std::vector<double> frequency(age_limit, 1e-9);
  double total = age_limit * 1e-9;
  for (const Ages& one : ages)
    for (std::size_t a = 0; a < age_limit; ++a)
      frequency[a] += static_cast<double>(one.ticks[a]), total += static_cast<double>(one.ticks[a]);
  for (double& s : frequency) s /= total;
  return frequency;
}

/// Fits the only parameter of a bus effect. Its interval contains the values whose likelihood is
/// within a factor e² of the largest one.
BusFit fit_one(effects::Placed placed, std::span<const Ages> train) {
  const double period_s = train[0].period_s;
  BusFit best{placed, 0, 0, 0, 0, false};
  const effects::Parameter parameter = effects::parameters(placed.effect)[0];
  std::vector<std::pair<double, double>> candidates;
  constexpr int steps = 120;  // chosen
  constexpr double interval_log_likelihood = 2;
  for (int n = 1; n <= steps; ++n) {
    *parameter.value = parameter.bounds.high * n / steps;
    candidates.emplace_back(likelihood(train, predicted_ages(placed, period_s)), *parameter.value);
  }
  const auto top = *std::ranges::max_element(candidates);
  best.low = best.high = top.second;
  double middle = 0, count = 0;
  for (const auto& [likelihood, value] : candidates)
    if (likelihood > top.first - interval_log_likelihood)
      best.low = std::min(best.low, value), best.high = std::max(best.high, value), middle += value,
      ++count;
  const double half_step = parameter.bounds.high / steps / 2;
  best.value = middle / count, best.low -= half_step, best.high += half_step;
  *parameter.value = best.value;
  best.placed = placed;
  return best;
}

}  // namespace

Ages command_ages(const residuals::Episode& episode, const erp::Robot& robot) {
  Ages ages{episode.period_s, std::vector<std::size_t>(age_limit, 0), 0, 0};
  for (std::size_t a = 0; a < robot.actuators.size(); ++a) {
    const residuals::ActuatorSignals& s = episode.actuators[a];
    if (!s.sent.empty()) {
      add_reported_ages(episode, s, ages);
      continue;
    }
    const Law law = law_of(s, robot, robot.actuators[a], episode.period_s);
    const double count_V = robot.motor_of(robot.actuators[a]).supply_V / ECU_DUTY_MAX;
    add_ages(episode, s, law, count_V, ages);
  }
  return ages;
}

bool has_enough_ages(std::span<const Ages> ages) {
  std::size_t determined = 0, checked = 0;
  for (const Ages& one : ages) determined += one.determined, checked += one.checked;
  return checked > least_checked &&
         static_cast<double>(determined) > least_determined * static_cast<double>(checked);
}

double delayed_fraction(std::span<const Ages> ages) {
  if (!has_enough_ages(ages)) return 0;
  const auto frequency = observed_ages(ages);
  return 1 - frequency[0];
}

double mean_age_s(std::span<const Ages> ages) {
  double sum_s = 0, count = 0;
  for (const Ages& one : ages)
    for (std::size_t a = 0; a < age_limit; ++a)
      sum_s += double(one.ticks[a]) * double(a) * one.period_s, count += double(one.ticks[a]);
  return count > 0 ? sum_s / count : 0;
}

std::vector<BusFit> fit_bus(std::span<const Ages> train, std::span<const Ages> held_out,
                            const erp::Robot& robot, const std::vector<std::string>& withhold) {
  std::vector<BusFit> fits;
  if (!has_enough_ages(train) || !has_enough_ages(held_out) ||
      delayed_fraction(held_out) < negligible_delayed_fraction)
    return fits;
  effects::Placed no_effect{robot.name, *effects::neutral("bus_command_delay")};
  const double before = likelihood(held_out, predicted_ages(no_effect, train[0].period_s));
  const double best_possible = likelihood(held_out, observed_ages(held_out));
  for (const effects::AnyEffect& effect : effects::library()) {
    const effects::About& about = effects::about(effect);
    if (about.stage != effects::Stage::bus || std::ranges::count(withhold, about.type)) continue;
    BusFit fit = fit_one({robot.name, effect}, train);
    fit.gain = (likelihood(held_out, predicted_ages(fit.placed, train[0].period_s)) - before) /
               std::max(best_possible - before, 1e-9);
    // Chosen: two simultaneous effects resemble jitter with 0.956.
    constexpr double supported_gain = 0.965;
    fit.supported = fit.gain > supported_gain;
    fits.push_back(std::move(fit));
  }
  std::ranges::stable_sort(fits, std::greater(), &BusFit::gain);
  return fits;
}

}  // namespace sim::diagnosis

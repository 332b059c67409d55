#include "sim/gap/closed_loop/free_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <optional>

#include "interfaces/parallel/in_parallel.hpp"
#include "interfaces/xml/values.hpp"
#include "sim/gap/residuals/indices.hpp"
#include "sim/gap/residuals/measured.hpp"
#include "sim/model/actuator/ecu_units.hpp"

namespace sim::closed_loop {
namespace {

using diagnosis::ClosedGap;
using residuals::Episode;
using residuals::Signal;

constexpr std::size_t held_rows = 10;      // the ECU holds its last command for 20 ms
constexpr double max_offset_rad = 0.05;    // from the initial pose; chosen
constexpr double max_period_error = 0.01;  // relative; chosen
constexpr int bootstrap_draws = 400;       // chosen

/// First row of a gap in which the commands are unknown because it is longer than held_rows;
/// `rows`: no such gap.
std::size_t first_long_gap(const residuals::ActuatorSignals& actuator, std::size_t rows) {
  const Signal& shaft = actuator.shaft_rad;
  std::size_t lost = 0;
  for (std::size_t k = 0; k < rows && !shaft.empty(); ++k) {
    lost = std::isnan(actuator.mode[k]) && std::isnan(shaft[k]) ? lost + 1 : 0;
    if (lost > held_rows) return k + 1 - lost;
  }
  return rows;
}

/// Reason why a recording cannot be simulated; empty: it can be simulated.
std::string obstacle(const Episode& e, const erp::Robot& robot) {
  if (std::abs(e.period_s / residuals::tick_s - 1) > max_period_error)
    return "its row period differs from the ECU tick of 2 ms";
  for (std::size_t a = 0; a < e.actuators.size(); ++a)
    if (e.actuators[a].mode.empty() || e.actuators[a].reference.empty())
      return "it lacks mode and reference of " + robot.actuators[a].name;
  for (const auto& actuator : e.actuators)
    if (const auto gap = first_long_gap(actuator, e.rows); gap < e.rows)
      return "rows are missing at " + xml::write_number(double(gap) * residuals::tick_s) + " s";
  const auto joints = robot.joints();
  for (std::size_t j = 0; j < joints.size(); ++j)
    if (const Signal& angle = e.joints[j].angle_rad;
        !angle.empty() && std::abs(angle[0] - joints[j].initial_rad) > max_offset_rad)
      return joints[j].name + " does not start in the model's initial pose";
  return "";
}

/// The sent set-point, converted from counts with the model's units; `reference` if the counts were
/// not recorded.
Signal commanded(const residuals::ActuatorSignals& recorded, const erp::Robot& robot,
                 const erp::Actuator& actuator) {
  const EcuUnits units(robot.motor_of(actuator), robot.sensors_of(actuator), actuator.spindle);
  Signal reference = recorded.reference;
  for (std::size_t k = 0; k < recorded.sent.size(); ++k)
    if (!std::isnan(recorded.mode[k]) && !std::isnan(recorded.sent[k]))
      reference[k] =
          units.reference(EcuUnits::request(static_cast<erp::Mode>(std::lround(recorded.mode[k]))),
                          static_cast<std::int32_t>(recorded.sent[k]));
  return reference;
}

/// The set-points of a recording. In missing rows the last command is held, as in the ECU.
SetPoints set_points_of(const Episode& e, const erp::Robot& robot) {
  SetPoints set_points(e.rows, std::vector<SetPoint>(e.actuators.size()));
  std::vector<std::size_t> missing(e.actuators.size());
  std::vector<Signal> references;
  for (std::size_t a = 0; a < e.actuators.size(); ++a)
    references.push_back(commanded(e.actuators[a], robot, robot.actuators[a]));
  for (std::size_t k = 0; k < e.rows; ++k)
    for (std::size_t a = 0; a < e.actuators.size(); ++a) {
      const double mode = e.actuators[a].mode[k];
      missing[a] = std::isnan(mode) ? missing[a] + 1 : 0;
      if (k > 0 && missing[a] > 0 && missing[a] <= held_rows)
        set_points[k][a] = set_points[k - 1][a];
      else if (std::isnan(mode)) set_points[k][a].reference = mode;
      else if (mode != 0)
        set_points[k][a] = {static_cast<erp::Mode>(std::lround(mode)), references[a][k]};
    }
  return set_points;
}

/// Sums of the squares of a channel's three errors over a second.
struct Second {
  double before = 0, floor = 0, after = 0, rows = 0;
};
using Errors = std::map<std::string, std::pair<std::string, std::vector<Second>>>;

/// Compares a recording with three simulations.
Errors errors_of(const Episode& e, const erp::Robot& nominal, const erp::Robot& found,
                 std::uint64_t seed, const LearnedEcu* learned) {
  const SetPoints set_points = set_points_of(e, nominal);
  std::vector<std::string> remarks;
  const auto run = [&](const erp::Robot& robot, std::uint64_t noise) {
    return residuals::lay_out(predict_run(robot, set_points, noise, {&nominal, learned}), nominal,
                              e.name, remarks);
  };
  const Episode before = run(nominal, seed), after = run(found, seed),
                second_noise = run(found, seed + 1);
  const auto real = residuals::measured(e, nominal),
             before_signals = residuals::measured(before, nominal),
             after_signals = residuals::measured(after, nominal),
             noise_signals = residuals::measured(second_noise, nominal);
  Errors errors;
  for (std::size_t c = 0; c < real.size(); ++c) {
    const Signal &truth = *real[c].signal, &b = *before_signals[c].signal,
                 &a = *after_signals[c].signal, &n = *noise_signals[c].signal;
    if (truth.empty()) continue;
    auto& [unit, seconds] = errors[real[c].column];
    unit = real[c].unit;
    seconds.resize(std::size_t(double(e.rows) * residuals::tick_s) + 1);
    for (std::size_t k = 0; k < std::min(e.rows, b.size()); ++k) {
      if (std::isnan(truth[k]) || !e.judged(k)) continue;
      Second& second = seconds[std::size_t(double(k) * residuals::tick_s)];
      second.before += std::pow(b[k] - truth[k], 2), second.after += std::pow(a[k] - truth[k], 2);
      second.floor += std::pow(n[k] - a[k], 2), ++second.rows;
    }
  }
  return errors;
}

ClosedGap closed_of(const std::string& name, const std::string& unit,
                    const std::vector<Second>& all, std::span<const std::size_t> drawn) {
  Second sum;
  for (const std::size_t k : drawn)
    sum.before += all[k].before, sum.floor += all[k].floor, sum.after += all[k].after,
        sum.rows += all[k].rows;
  const auto rms = [&](double square) { return std::sqrt(square / std::max(1.0, sum.rows)); };
  ClosedGap c{name, unit, rms(sum.before), rms(sum.floor), rms(sum.after)};
  c.closed = c.before > c.floor ? (c.before - c.after) / (c.before - c.floor) : 0;
  return c;
}

ClosedGap all_of(const Errors& errors, std::span<const std::size_t> drawn) {
  double before = 0, after = 0, count = 0;
  for (const auto& [name, channel] : errors) {
    const ClosedGap c = closed_of(name, channel.first, channel.second, drawn);
    if (!(c.floor > 0)) continue;
    before += std::pow(c.before / c.floor, 2), after += std::pow(c.after / c.floor, 2), ++count;
  }
  count = std::max(1.0, count);
  ClosedGap c{"all", "noise", std::sqrt(before / count), 1, std::sqrt(after / count)};
  c.closed = c.before > c.floor ? (c.before - c.after) / (c.before - c.floor) : 0;
  return c;
}

/// Learned laws of the ECUs, if they differ from this product's firmware and can be learned.
std::optional<LearnedEcu> foreign_ecu(std::span<const Episode> recordings, const erp::Robot& robot,
                                      std::vector<std::string>& remarks) {
  constexpr double same_firmware = 0.05;  // largest unexplained variance; chosen
  // Largest, to the variance that the firmware leaves; chosen.
  constexpr double learned_ratio = 0.5;
  const double unexplained = unexplained_by_firmware(recordings, robot, same_firmware);
  if (unexplained < same_firmware) return {};
  LearnedEcu ecu = learn(recordings, robot);
  std::erase_if(
      ecu, [&](const auto& law) { return law.second.unexplained > learned_ratio * unexplained; });
  if (ecu.empty()) return {};
  double worst = 0;
  for (const auto& [mode, law] : ecu) worst = std::max(worst, law.unexplained);
  remarks.push_back(fmt::format(
      "the free run uses laws learned from the recordings for the ECUs: they leave {:.2g} % of the "
      "variance of the voltages unexplained, this product's firmware {:.3g} %",
      100 * worst, 100 * std::min(1.0, unexplained)));
  return ecu;
}

/// Whether the learned laws include the delays of the bus. Laws that are learned from sent
/// set-points do; laws that are learned from set-points that the ECU reports do not.
bool has_delays(const std::optional<LearnedEcu>& learned, std::span<const Episode> recordings) {
  return learned && std::ranges::all_of(recordings, [](const Episode& e) {
           return std::ranges::all_of(e.actuators, [](const auto& a) { return a.sent.empty(); });
         });
}

/// The robot without its effects on the bus.
erp::Robot without_bus(erp::Robot robot) {
  std::erase_if(robot.effects, [](const erp::Effect& e) {
    const auto effect = effects::neutral(e.type);
    return effect && effects::about(*effect).stage == effects::Stage::bus;
  });
  return robot;
}

}  // namespace

FreeRun free_run(const erp::Robot& nominal, const erp::Robot& found,
                 std::span<const Episode> recordings, const FreeRunOptions& options) {
  FreeRun result;
  const auto learned = foreign_ecu(recordings, nominal, result.remarks);
  const erp::Robot simulated = has_delays(learned, recordings) ? without_bus(found) : found;
  std::vector<Errors> recording_errors(recordings.size());
  std::vector<std::string> reasons(recordings.size());
  std::size_t finished = 0;
  std::mutex reporting;
  in_parallel(recordings.size(), options.threads, [&](std::size_t r) {
    reasons[r] = obstacle(recordings[r], nominal);
    try {
      if (reasons[r].empty())
        recording_errors[r] = errors_of(recordings[r], nominal, simulated, options.seed + 2 * r,
                                        learned ? &*learned : nullptr);
    } catch (const std::exception& error) {
      reasons[r] = error.what();
    }
    const std::lock_guard lock(reporting);
    if (options.progress) options.progress(double(++finished) / double(recordings.size()));
  });
  Errors errors;
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    if (!reasons[r].empty())
      result.remarks.push_back(recordings[r].name + ": left out of the free run: " + reasons[r]);
    for (const auto& [name, channel] : recording_errors[r]) {
      errors[name].first = channel.first;
      auto& seconds = errors[name].second;
      seconds.insert(seconds.end(), channel.second.begin(), channel.second.end());
    }
  }
  if (errors.empty()) return result;
  const auto all_seconds = each(errors.begin()->second.second.size());
  const auto interval = [&](auto of) {
    return diagnosis::middle(
        diagnosis::bootstrap(all_seconds.size(), bootstrap_draws, options.seed,
                             [&](const auto& drawn) { return of(drawn).closed; }));
  };
  for (const auto& [name, channel] : errors) {
    const auto of = [&](std::span<const std::size_t> drawn) {
      return closed_of(name, channel.first, channel.second, drawn);
    };
    result.channels.push_back(of(all_seconds));
    result.channels.back().interval = interval(of);
  }
  result.all = all_of(errors, all_seconds);
  result.all.interval = interval([&](const auto& drawn) { return all_of(errors, drawn); });
  return result;
}

}  // namespace sim::closed_loop

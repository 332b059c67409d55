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

using diagnosis::Closed;
using residuals::Episode;
using residuals::Signal;

constexpr double tick_s = 0.002;
constexpr std::size_t held_rows = 10;  // a robot keeps its last command for 20 ms
constexpr double apart_rad = 0.05;     // largest distance from the initial pose; chosen

/// First row of a gap so long that the commands in it are unknown; `rows` if there is none.
std::size_t first_long_gap(const residuals::ActuatorSignals& actuator, std::size_t rows) {
  const Signal& shaft = actuator.shaft_rad;
  std::size_t lost = 0;
  for (std::size_t k = 0; k < rows && !shaft.empty(); ++k) {
    lost = std::isnan(actuator.mode[k]) && std::isnan(shaft[k]) ? lost + 1 : 0;
    if (lost > held_rows) return k + 1 - lost;
  }
  return rows;
}

/// Reason why a recording cannot be simulated; empty: it can.
std::string obstacle(const Episode& e, const erp::Robot& robot) {
  if (std::abs(e.period_s / tick_s - 1) > 0.01)
    return "its row period differs from the ECU tick of 2 ms";
  for (std::size_t a = 0; a < e.actuators.size(); ++a)
    if (e.actuators[a].mode.empty() || e.actuators[a].reference.empty())
      return "it lacks mode and reference of " + robot.actuators[a].name;
  for (const auto& actuator : e.actuators)
    if (const auto gap = first_long_gap(actuator, e.rows); gap < e.rows)
      return "rows are missing at " + xml::write_number(double(gap) * tick_s) + " s";
  const auto joints = robot.joints();
  for (std::size_t j = 0; j < joints.size(); ++j)
    if (const Signal& angle = e.joints[j].angle_rad;
        !angle.empty() && std::abs(angle[0] - joints[j].initial_rad) > apart_rad)
      return joints[j].name + " does not start in the model's initial pose";
  return "";
}

/// The set-point as sent, converted from counts with the model's units; `reference` if the counts were not recorded.
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

/// In missing rows the last command is kept, as in the robot.
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

/// Squares of a channel's three errors over a second.
struct Second {
  double before = 0, floor = 0, after = 0, rows = 0;
};
using Errors = std::map<std::string, std::pair<std::string, std::vector<Second>>>;

/// Three simulations of one recording, compared with it.
Errors errors_of(const Episode& e, const erp::Robot& nominal, const erp::Robot& found,
                 std::uint64_t seed, const LearnedEcu* learned) {
  const SetPoints set_points = set_points_of(e, nominal);
  std::vector<std::string> remarks;
  const auto run = [&](const erp::Robot& robot, std::uint64_t noise) {
    return residuals::lay_out(predict_run(robot, set_points, noise, {&nominal, learned}), nominal,
                              e.name, remarks);
  };
  const Episode before = run(nominal, seed), after = run(found, seed), again = run(found, seed + 1);
  const auto real = residuals::measured(e, nominal), was = residuals::measured(before, nominal),
             is = residuals::measured(after, nominal), noisy = residuals::measured(again, nominal);
  Errors errors;
  for (std::size_t c = 0; c < real.size(); ++c) {
    const Signal &truth = *real[c].signal, &b = *was[c].signal, &a = *is[c].signal,
                 &n = *noisy[c].signal;
    if (truth.empty()) continue;
    auto& [unit, seconds] = errors[real[c].column];
    unit = real[c].unit;
    seconds.resize(std::size_t(double(e.rows) * tick_s) + 1);
    for (std::size_t k = 0; k < std::min(e.rows, b.size()); ++k) {
      if (std::isnan(truth[k]) || !e.judged(k)) continue;
      Second& second = seconds[std::size_t(double(k) * tick_s)];
      second.before += std::pow(b[k] - truth[k], 2), second.after += std::pow(a[k] - truth[k], 2);
      second.floor += std::pow(n[k] - a[k], 2), ++second.rows;
    }
  }
  return errors;
}

Closed closed_of(const std::string& name, const std::string& unit, const std::vector<Second>& all,
                 std::span<const std::size_t> drawn) {
  Second sum;
  for (const std::size_t k : drawn)
    sum.before += all[k].before, sum.floor += all[k].floor, sum.after += all[k].after,
        sum.rows += all[k].rows;
  const auto rms = [&](double square) { return std::sqrt(square / std::max(1.0, sum.rows)); };
  Closed c{name, unit, rms(sum.before), rms(sum.floor), rms(sum.after)};
  c.closed = c.before > c.floor ? (c.before - c.after) / (c.before - c.floor) : 0;
  return c;
}

Closed all_of(const Errors& errors, std::span<const std::size_t> drawn) {
  double before = 0, after = 0, count = 0;
  for (const auto& [name, channel] : errors) {
    const Closed c = closed_of(name, channel.first, channel.second, drawn);
    if (!(c.floor > 0)) continue;
    before += std::pow(c.before / c.floor, 2), after += std::pow(c.after / c.floor, 2), ++count;
  }
  count = std::max(1.0, count);
  Closed c{"all", "noise", std::sqrt(before / count), 1, std::sqrt(after / count)};
  c.closed = c.before > c.floor ? (c.before - c.after) / (c.before - c.floor) : 0;
  return c;
}

/// Learned laws of the ECUs, if they differ from this product's firmware and can be learned.
std::optional<LearnedEcu> foreign_ecu(std::span<const Episode> recordings, const erp::Robot& robot,
                                      std::vector<std::string>& remarks) {
  constexpr double ours = 0.05, known = 0.5;  // of the voltages' variance; of that; chosen
  const double unexplained = unexplained_by_firmware(recordings, robot, ours);
  if (unexplained < ours) return {};
  LearnedEcu ecu = learn(recordings, robot);
  std::erase_if(ecu, [&](const auto& law) { return law.second.unexplained > known * unexplained; });
  if (ecu.empty()) return {};
  double worst = 0;
  for (const auto& [mode, law] : ecu) worst = std::max(worst, law.unexplained);
  remarks.push_back(fmt::format(
      "the free run uses laws learned from the recordings for the ECUs: they leave {:.2g} % of the "
      "variance of the voltages unexplained, this product's firmware {:.3g} %",
      100 * worst, 100 * std::min(1.0, unexplained)));
  return ecu;
}

/// Whether the learned laws include the delays of the bus: they do if learned from set-points as sent, and do not if
/// learned from set-points that the ECU reports.
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
  const erp::Robot free = has_delays(learned, recordings) ? without_bus(found) : found;
  std::vector<Errors> of_recording(recordings.size());
  std::vector<std::string> why(recordings.size());
  std::size_t done = 0;
  std::mutex reporting;
  in_parallel(recordings.size(), options.threads, [&](std::size_t r) {
    why[r] = obstacle(recordings[r], nominal);
    try {
      if (why[r].empty())
        of_recording[r] = errors_of(recordings[r], nominal, free, options.seed + 2 * r,
                                    learned ? &*learned : nullptr);
    } catch (const std::exception& failed) {
      why[r] = failed.what();
    }
    const std::lock_guard lock(reporting);
    if (options.progress) options.progress(double(++done) / double(recordings.size()));
  });
  Errors errors;
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    if (!why[r].empty())
      result.remarks.push_back(recordings[r].name + ": left out of the free run: " + why[r]);
    for (const auto& [name, channel] : of_recording[r]) {
      errors[name].first = channel.first;
      auto& seconds = errors[name].second;
      seconds.insert(seconds.end(), channel.second.begin(), channel.second.end());
    }
  }
  if (errors.empty()) return result;
  const auto every = each(errors.begin()->second.second.size());
  const auto interval = [&](auto of) {
    return diagnosis::middle(diagnosis::bootstrap(
        every.size(), 400, options.seed, [&](const auto& drawn) { return of(drawn).closed; }));
  };
  for (const auto& [name, channel] : errors) {
    const auto of = [&](std::span<const std::size_t> drawn) {
      return closed_of(name, channel.first, channel.second, drawn);
    };
    result.channels.push_back(of(every));
    result.channels.back().interval = interval(of);
  }
  result.all = all_of(errors, every);
  result.all.interval = interval([&](const auto& drawn) { return all_of(errors, drawn); });
  return result;
}

}  // namespace sim::closed_loop

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <mutex>
#include <nlohmann/json.hpp>
#include <ostream>
#include <set>

#include "launch/erp/gap/former_keys.hpp"
#include "launch/erp/gap/gap.hpp"
#include "launch/erp/gap/planned_graph.hpp"
#include "launch/erp/text/progress.hpp"
#include "launch/erp/text/text_files.hpp"
#include "sim/gap/closed_loop/experiment.hpp"

namespace launch::gap {
namespace {

namespace closed_loop = sim::closed_loop;
using PlanJson = nlohmann::json;
using sim::effects::name_of;
using sim::effects::Placed;

constexpr std::size_t max_suspects = 4;
// Smallest difference, in standard deviations, with which an excitation distinguishes two suspects.
// Chosen.
constexpr double min_sigma = 3;

Placed placed_of(const PlanJson& effect, const std::string& file) {
  const auto type = effect.at("type").get<std::string>();
  auto neutral = sim::effects::neutral(type);
  if (!neutral)
    throw std::invalid_argument(file + ": effect " + type +
                                " is not in the library; diagnose again with this version of erp");
  Placed placed{effect.at("on").get<std::string>(), *neutral};
  for (const auto& parameter : sim::effects::parameters(placed.effect))
    if (effect.at("parameters").contains(parameter.name))
      *parameter.value = effect["parameters"][parameter.name].get<double>();
  return placed;
}

bool is_same(const PlanJson& a, const PlanJson& b) {
  return a.at("type") == b.at("type") && a.at("on") == b.at("on");
}

/// The effects to be distinguished (suspects), and the other identified effects of the robot. Both
/// lists exclude effects of the bus, which change no residual.
struct Problem {
  std::string robot;  ///< name of the diagnosed robot
  std::vector<Placed> suspects, identified;
  std::size_t more_sets = 0;  ///< further sets of equivalent effects
  bool fix_first = false;     ///< the diagnosed recordings have faults
};

/// Takes the first set of equivalent effects as suspects. Without such a set, takes the answer;
/// without an answer, the highest-ranked candidates.
Problem problem_of(const PlanJson& d, const std::string& file) {
  const auto on_bus = [](const PlanJson& effect) {
    return effect.at("type").get<std::string>().starts_with("bus_");
  };
  std::vector<PlanJson> set;
  std::set<int> sets;
  for (const PlanJson& entry : d.at("confounders")) {
    if (on_bus(entry)) continue;
    sets.insert(entry.value("set", 0));
    if (sets.size() == 1) set.push_back(entry);
  }
  const bool split = !set.empty(), is_supported = d.at("verdict") == "supported";
  Problem problem{
      d.at("robot"), {}, {}, sets.size() - split, !d.value("fix_first", PlanJson::array()).empty()};
  for (const PlanJson& effect : d.at("effects")) {
    if (on_bus(effect)) continue;
    const bool supported = effect.at("supported").get<bool>();
    if (!split && (!is_supported || (supported && set.empty()))) set.push_back(effect);
    else if (supported &&
             std::ranges::none_of(set, [&](const PlanJson& s) { return is_same(s, effect); }))
      problem.identified.push_back(placed_of(effect, file));
  }
  for (const PlanJson& entry : set)
    if (problem.suspects.size() < max_suspects) problem.suspects.push_back(placed_of(entry, file));
  return problem;
}

Problem read_problem(const std::string& file) {
  const std::string text = read_text(file);
  try {
    return problem_of(parse_diagnosis<PlanJson>(text, file), file);
  } catch (const PlanJson::exception& e) {
    const std::string reason = e.what();  // text after the library's error code
    throw std::invalid_argument(file + ": is not a diagnosis.json of erp gap diagnose (" +
                                reason.substr(reason.find("] ") + 2) +
                                "); pass the diagnosis.json that erp gap diagnose wrote");
  }
}

void print(const closed_loop::Experiment& experiment, const erp::Robot& robot,
           const std::vector<Placed>& suspects, std::ostream& out) {
  out << "suspects    " << name_of(suspects[0]);
  for (std::size_t k = 1; k < suspects.size(); ++k) out << ", " << name_of(suspects[k]);
  if (suspects.size() == 1) out << ", compared with the robot without it";
  out << fmt::format("\n{:<12}{:<18} {:>6} {:>12} {:>10}  {}\n", "", "excitation", "seed",
                     "diff., sigma", "tension", "");
  constexpr std::size_t max_rows = 5;
  for (std::size_t k = 0; k < std::min(max_rows, experiment.candidates.size()); ++k) {
    const auto& c = experiment.candidates[k];
    out << fmt::format("{:<12}{:<18} {:>6} {:>12.1f} {:>8.0f} %  {}\n", k ? "" : "candidates",
                       sim::excitation_name(robot, c.kind), c.seed, c.least_split,
                       100 * c.extremes.tension_fraction, c.unsafe);
  }
  if (suspects.size() < 3) return;  // with two suspects the table contains the difference
  const auto& split = experiment.candidates.front().split;
  for (std::size_t k = 0; k < split.size(); ++k)
    out << fmt::format("{:<12}{:.1f} sigma to {}\n", k ? "" : "best", split[k],
                       name_of(suspects[k + 1]));
}

/// The suspects that no safe excitation distinguishes from the first.
std::vector<Placed> never_distinguished(const closed_loop::Experiment& experiment,
                                        const std::vector<Placed>& suspects) {
  std::vector<Placed> indistinguishable;
  for (std::size_t k = 1; k < suspects.size(); ++k)
    if (std::ranges::none_of(experiment.candidates, [&](const closed_loop::Candidate& c) {
          return c.unsafe.empty() && c.split[k - 1] >= min_sigma;
        }))
      indistinguishable.push_back(suspects[k]);
  return indistinguishable;
}

std::string joined(const std::vector<Placed>& effects) {
  std::vector<std::string> names;
  for (const Placed& effect : effects) names.push_back(name_of(effect));
  return fmt::format("{}", fmt::join(names, ", "));
}

closed_loop::Experiment search(const erp::Robot& robot, const std::vector<Placed>& suspects,
                               const PlanOptions& options, std::ostream& remarks) {
  Progress progress(remarks);
  std::mutex progress_mutex;
  closed_loop::ExperimentOptions search_options{.seconds = options.seconds,
                                                .candidates = options.candidates,
                                                .threads = options.threads,
                                                .seed = options.seed,
                                                .stop_distance_rad = options.to_stop_rad};
  search_options.progress = [&](double share) {
    const std::lock_guard lock(progress_mutex);
    progress.show("simulations", share);
  };
  return closed_loop::next_experiment(robot, suspects, search_options);
}

/// Throws std::invalid_argument if an effect acts on a part that the robot does not have.
void check_places(const erp::Robot& robot, const std::vector<Placed>& effects,
                  const PlanOptions& options) {
  for (const Placed& placed : effects) {
    const auto places = sim::effects::places(robot, sim::effects::about(placed.effect).seat);
    if (std::ranges::find(places, placed.on) == places.end())
      throw std::invalid_argument(options.diagnosis + ": " + name_of(placed) + ": " +
                                  options.robot +
                                  " has no such part; pass the robot that was diagnosed");
  }
}

/// Whether two effects have the same type, the same part of the robot and, within 0.1 %, the same
/// parameters.
bool is_same(Placed a, Placed b) {
  if (a.on != b.on || a.effect.index() != b.effect.index()) return false;
  constexpr double rounding = 1e-3;  // diagnosis.json has fewer digits than robot.xml
  return std::ranges::equal(sim::effects::parameters(a.effect), sim::effects::parameters(b.effect),
                            [](const auto& p, const auto& q) {
                              return std::abs(*p.value - *q.value) <= rounding * std::abs(*q.value);
                            });
}

/// Removes the effects of the answer: the robot.xml that erp gap diagnose wrote becomes the
/// diagnosed model again.
void remove_effects(erp::Robot& robot, const std::vector<Placed>& answer) {
  const auto existing = sim::effects::read_effects(robot);  // in the order of robot.effects
  std::vector<erp::Effect> remaining;
  for (std::size_t k = 0; k < existing.size(); ++k)
    if (std::ranges::none_of(answer, [&](const Placed& a) { return is_same(existing[k], a); }))
      remaining.push_back(robot.effects[k]);
  robot.effects = std::move(remaining);
}

}  // namespace

int plan(const PlanOptions& options, std::ostream& out, std::ostream& remarks) {
  erp::Robot robot = erp::read_robot(options.robot);
  if (robot.actuators.empty())
    throw std::invalid_argument(options.robot +
                                ": has no actuator to move; pass a robot with muscles");
  auto [diagnosed, suspects, identified, more_sets, fix_first] = read_problem(options.diagnosis);
  if (diagnosed != robot.name)
    throw std::invalid_argument(options.diagnosis + ": belongs to robot \"" + diagnosed +
                                "\", but " + options.robot + " is \"" + robot.name +
                                "\"; pass the robot that was diagnosed");
  check_places(robot, suspects, options), check_places(robot, identified, options);
  check_folder(options.out);
  remove_earlier_plan(options.out);
  remove_effects(robot, suspects), remove_effects(robot, identified);
  for (const Placed& placed : identified) robot.effects.push_back(sim::effects::written(placed));
  if (suspects.empty()) {
    out << "nothing to plan: the diagnosis contains no effect that a motion can distinguish "
           "(constants are all estimated, and effects of the bus change no residual)\n";
    return 1;
  }
  if (fix_first)
    remarks
        << options.diagnosis
        << ": fix its recordings first (see fix_first in it); until then its answer and this plan "
           "may be wrong\n";
  auto experiment = search(robot, suspects, options, remarks);
  const auto indistinguishable = never_distinguished(experiment, suspects);
  if (!experiment.chosen.reference.empty() && !indistinguishable.empty()) {
    out << fmt::format("no excitation distinguishes {} from {}; this needs another sensor\n",
                       name_of(suspects[0]), joined(indistinguishable));
    if (indistinguishable.size() + 1 == suspects.size()) return 5;
    std::erase_if(suspects, [&](const Placed& s) {
      return std::ranges::any_of(indistinguishable,
                                 [&](const Placed& n) { return name_of(n) == name_of(s); });
    });
    experiment = search(robot, suspects, options, remarks);  // for the remaining suspects
  }
  print(experiment, robot, suspects, out);
  if (experiment.chosen.reference.empty()) {
    out << "no candidate is safe; try another --seed, more --candidates, or a smaller --margin\n";
    return 1;
  }
  const auto& best_candidate = experiment.candidates.front();
  if (best_candidate.least_split < min_sigma) {
    out << (suspects.size() == 1
                ? "no excitation distinguishes it from the robot without it; this needs another "
                  "sensor\n"
                : "no single excitation distinguishes all of them; try more --candidates\n");
    return 5;
  }
  write_graph(options.out, options.robot, robot, experiment.chosen);
  out << fmt::format("chosen      largest tension {:.0f} % of the limit ({})",
                     100 * best_candidate.extremes.tension_fraction,
                     best_candidate.extremes.tension_actuator);
  if (!best_candidate.extremes.stop_joint.empty())
    out << fmt::format(", smallest distance to a stop {:.3f} rad ({})",
                       best_candidate.extremes.stop_distance_rad,
                       best_candidate.extremes.stop_joint);
  if (!best_candidate.extremes.saturated_actuator.empty())
    out << fmt::format(", full voltage for {:.0f} % of the time ({})",
                       100 * best_candidate.extremes.saturated_fraction,
                       best_candidate.extremes.saturated_actuator);
  out << fmt::format(
      "\nnext        erp launch {}/graph.xml --for {:g}s        on the robot, add --device can\n",
      options.out, options.seconds);
  if (more_sets)
    out << fmt::format(
        "then        diagnose with the new recording and plan again: {} more set{} of equivalent "
        "effects\n",
        more_sets, more_sets == 1 ? "" : "s");
  return 0;
}

}  // namespace launch::gap

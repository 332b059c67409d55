#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <mutex>
#include <nlohmann/json.hpp>
#include <ostream>
#include <set>

#include "launch/erp/gap/gap.hpp"
#include "launch/erp/gap/planned_graph.hpp"
#include "launch/erp/text/progress.hpp"
#include "launch/erp/text/text_files.hpp"
#include "sim/gap/closed_loop/experiment.hpp"

namespace launch::gap {
namespace {

namespace closed_loop = sim::closed_loop;
using Json = nlohmann::json;
using sim::effects::name_of;
using sim::effects::Placed;

constexpr std::size_t most_suspects = 4;
constexpr double telling = 3;  // standard deviations: below, an excitation splits nothing; chosen

Placed placed_of(const Json& effect, const std::string& file) {
  const auto type = effect.at("type").get<std::string>();
  auto neutral = sim::effects::neutral(type);
  if (!neutral) throw std::invalid_argument(file + ": effect " + type + " is not in the library");
  Placed placed{effect.at("on").get<std::string>(), *neutral};
  for (const auto& parameter : sim::effects::parameters(placed.effect))
    if (effect.at("parameters").contains(parameter.name))
      *parameter.value = effect["parameters"][parameter.name].get<double>();
  return placed;
}

bool same(const Json& a, const Json& b) {
  return a.at("type") == b.at("type") && a.at("on") == b.at("on");
}

/// What is to be split, and what is taken for true beside it. The bus is in neither: the stages'
/// residuals do not show it.
struct Question {
  std::string robot;  ///< that was diagnosed
  std::vector<Placed> suspects, known;
  std::size_t more_sets = 0;  ///< that could not be told apart either
  bool fix_first = false;     ///< the recordings that were diagnosed are odd
};

/// Of sets that could not be told apart, the first; else the answer; else what comes nearest.
Question question_of(const Json& d, const std::string& file) {
  const auto on_bus = [](const Json& effect) {
    return effect.at("type").get<std::string>().starts_with("bus_");
  };
  std::vector<Json> set;
  std::set<int> sets;
  for (const Json& one : d.at("confusable")) {
    if (on_bus(one)) continue;
    sets.insert(one.value("set", 0));
    if (sets.size() == 1) set.push_back(one);
  }
  const bool split = !set.empty(), answered = d.at("verdict") == "supported";
  Question question{
      d.at("robot"), {}, {}, sets.size() - split, !d.value("mend_first", Json::array()).empty()};
  for (const Json& effect : d.at("effects")) {
    if (on_bus(effect)) continue;
    const bool supported = effect.at("supported").get<bool>();
    if (!split && (!answered || (supported && set.empty()))) set.push_back(effect);
    else if (supported && std::ranges::none_of(set, [&](const Json& s) { return same(s, effect); }))
      question.known.push_back(placed_of(effect, file));
  }
  for (const Json& one : set)
    if (question.suspects.size() < most_suspects) question.suspects.push_back(placed_of(one, file));
  return question;
}

Question read_question(const std::string& file) {
  const std::string text = read_text(file);
  try {
    return question_of(Json::parse(text), file);
  } catch (const Json::exception& e) {
    const std::string why = e.what();  // behind the library's own name for it
    throw std::invalid_argument(file + ": is no diagnosis.json of erp gap diagnose (" +
                                why.substr(why.find("] ") + 2) + "); give one");
  }
}

void print(const closed_loop::Experiment& experiment, const erp::Robot& robot,
           const std::vector<Placed>& suspects, std::ostream& out) {
  out << "to split    " << name_of(suspects[0]);
  for (std::size_t k = 1; k < suspects.size(); ++k) out << ", " << name_of(suspects[k]);
  if (suspects.size() == 1) out << ", from the robot without it";
  out << fmt::format("\n{:<12}{:<18} {:>6} {:>12} {:>10}  {}\n", "", "excitation", "seed",
                     "split, sigma", "tension", "");
  constexpr std::size_t shown = 5;
  for (std::size_t k = 0; k < std::min(shown, experiment.candidates.size()); ++k) {
    const auto& c = experiment.candidates[k];
    out << fmt::format("{:<12}{:<18} {:>6} {:>12.1f} {:>8.0f} %  {}\n", k ? "" : "candidates",
                       sim::excitation_word(robot, c.kind), c.seed, c.least,
                       100 * c.extremes.of_max_tension, c.unsafe);
  }
  if (suspects.size() < 3) return;  // with two the table says it
  const auto& split = experiment.candidates.front().split;
  for (std::size_t k = 0; k < split.size(); ++k)
    out << fmt::format("{:<12}{:.1f} sigma from {}\n", k ? "" : "the first", split[k],
                       name_of(suspects[k + 1]));
}

/// Those that no safe excitation tells from the first.
std::vector<Placed> never_split(const closed_loop::Experiment& experiment,
                                const std::vector<Placed>& suspects) {
  std::vector<Placed> never;
  for (std::size_t k = 1; k < suspects.size(); ++k)
    if (std::ranges::none_of(experiment.candidates, [&](const closed_loop::Candidate& c) {
          return c.unsafe.empty() && c.split[k - 1] >= telling;
        }))
      never.push_back(suspects[k]);
  return never;
}

std::string joined(const std::vector<Placed>& effects) {
  std::vector<std::string> names;
  for (const Placed& effect : effects) names.push_back(name_of(effect));
  return fmt::format("{}", fmt::join(names, ", "));
}

closed_loop::Experiment rehearsed(const erp::Robot& robot, const std::vector<Placed>& suspects,
                                  const PlanOptions& options, std::ostream& remarks) {
  Progress progress(remarks);
  std::mutex telling_mutex;
  closed_loop::ExperimentOptions how{.seconds = options.seconds,
                                     .candidates = options.candidates,
                                     .threads = options.threads,
                                     .seed = options.seed,
                                     .to_stop_rad = options.to_stop_rad};
  how.progress = [&](double share) {
    const std::lock_guard lock(telling_mutex);
    progress.tell("rehearsals", share);
  };
  return closed_loop::next_experiment(robot, suspects, how);
}

/// Throws std::invalid_argument where an effect is on nothing of this robot.
void check_is_of(const erp::Robot& robot, const std::vector<Placed>& effects,
                 const PlanOptions& options) {
  for (const Placed& placed : effects) {
    const auto places = sim::effects::places(robot, sim::effects::about(placed.effect).seat);
    if (std::ranges::find(places, placed.on) == places.end())
      throw std::invalid_argument(options.diagnosis + ": " + name_of(placed) + ": " +
                                  options.robot +
                                  " has no such place; give the robot that was diagnosed");
  }
}

/// Whether both have the same type, place and, to a thousandth, the same values.
bool same(Placed a, Placed b) {
  if (a.on != b.on || a.effect.index() != b.effect.index()) return false;
  constexpr double rounded = 1e-3;  // diagnosis.json has fewer digits than robot.xml
  return std::ranges::equal(sim::effects::parameters(a.effect), sim::effects::parameters(b.effect),
                            [](const auto& p, const auto& q) {
                              return std::abs(*p.value - *q.value) <= rounded * std::abs(*q.value);
                            });
}

/// The robot that was diagnosed, if this one is the robot.xml of the diagnosis: without its answer.
void remove_effects(erp::Robot& robot, const std::vector<Placed>& answer) {
  const auto has = sim::effects::read_effects(robot);  // in the order of robot.effects
  std::vector<erp::Effect> kept;
  for (std::size_t k = 0; k < has.size(); ++k)
    if (std::ranges::none_of(answer, [&](const Placed& a) { return same(has[k], a); }))
      kept.push_back(robot.effects[k]);
  robot.effects = std::move(kept);
}

}  // namespace

int plan(const PlanOptions& options, std::ostream& out, std::ostream& remarks) {
  erp::Robot robot = erp::read_robot(options.robot);
  if (robot.actuators.empty())
    throw std::invalid_argument(options.robot + ": the simulator has nothing to move: no actuator");
  auto [diagnosed, suspects, known, more_sets, fix_first] = read_question(options.diagnosis);
  if (diagnosed != robot.name)
    throw std::invalid_argument(options.diagnosis + ": is of robot \"" + diagnosed + "\", " +
                                options.robot + " is \"" + robot.name +
                                "\"; give the robot that was diagnosed");
  check_is_of(robot, suspects, options), check_is_of(robot, known, options);
  check_folder(options.out);
  make_way(options.out);
  remove_effects(robot, suspects), remove_effects(robot, known);
  for (const Placed& placed : known) robot.effects.push_back(sim::effects::written(placed));
  if (suspects.empty()) {
    out << "nothing to plan for: the diagnosis names no effect that a motion could show (constants "
           "are estimated without a choice, and the bus shows in no motion)\n";
    return 1;
  }
  if (fix_first)
    remarks << options.diagnosis
            << ": its recordings are to be mended first, see its warnings: its answer and "
               "this plan may be wrong\n";
  auto experiment = rehearsed(robot, suspects, options, remarks);
  const auto never = never_split(experiment, suspects);
  if (!experiment.chosen.reference.empty() && !never.empty()) {
    out << fmt::format("no excitation tells {} from {}: that needs another sensor\n",
                       name_of(suspects[0]), joined(never));
    if (never.size() + 1 == suspects.size()) return 5;
    std::erase_if(suspects, [&](const Placed& s) {
      return std::ranges::any_of(never, [&](const Placed& n) { return name_of(n) == name_of(s); });
    });
    experiment = rehearsed(robot, suspects, options, remarks);  // of the others
  }
  print(experiment, robot, suspects, out);
  if (experiment.chosen.reference.empty()) {
    out << "no candidate is safe; try others with --seed or --candidates, or a smaller --margin\n";
    return 1;
  }
  const auto& best = experiment.candidates.front();
  if (best.least < telling) {
    out << (suspects.size() == 1
                ? "no excitation tells it from the robot without it: that needs another sensor\n"
                : "none of these excitations splits all of them at once: try more with "
                  "--candidates\n");
    return 5;
  }
  write_graph(options.out, options.robot, robot, experiment.chosen);
  out << fmt::format("chosen      largest tension {:.0f} % of the limit ({})",
                     100 * best.extremes.of_max_tension, best.extremes.tightest);
  if (!best.extremes.nearest.empty())
    out << fmt::format(", {:.3f} rad to a stop ({})", best.extremes.to_stop_rad,
                       best.extremes.nearest);
  if (!best.extremes.slowest.empty())
    out << fmt::format(", at full voltage for {:.0f} % of the time ({})",
                       100 * best.extremes.saturated, best.extremes.slowest);
  out << fmt::format(
      "\nrun it      erp launch {}/graph.xml --for {:g}s        on the robot: --device can\n",
      options.out, options.seconds);
  if (more_sets)
    out << fmt::format(
        "then        diagnose with it and plan again: {} more set{} cannot be told apart\n",
        more_sets, more_sets == 1 ? "" : "s");
  return 0;
}

}  // namespace launch::gap

#include "sim/gap/diagnosis/diagnose.hpp"

#include <algorithm>
#include <functional>
#include <optional>
#include <stdexcept>

#include "sim/gap/diagnosis/conclusion.hpp"
#include "sim/gap/diagnosis/effect_set.hpp"
#include "sim/gap/diagnosis/identifiability.hpp"
#include "sim/gap/diagnosis/residual_split.hpp"
#include "sim/gap/diagnosis/shapley.hpp"

namespace sim::diagnosis {
namespace {

/// Each once: a recording that is cut is two episodes.
std::vector<std::string> names_of(const Problem& problem, const std::vector<std::size_t>& set) {
  std::vector<std::string> names;
  for (const std::size_t k : set)
    if (std::ranges::count(names, problem.episodes[k].name) == 0)
      names.push_back(problem.episodes[k].name);
  return names;
}

/// The best effect alone leaves nothing but noise, and the robot is one on which the joint estimate
/// takes many minutes: its time grows with the square of the actuators.
bool leaves_noise_on_large_robot(const Problem& problem, const Selection& selection) {
  constexpr std::size_t large = 12;  // actuators; chosen
  constexpr double noise = 0.2;      // of its square; chosen
  return problem.robot.actuators.size() > large && selection.explained() &&
         std::ranges::none_of(selection.left, [](const StageGap& g) { return g.excess > noise; });
}

/// Both name the same one effect, and say that it explains.
bool agree(const JointEstimate& built, const Selection& selection) {
  return built.exact && built.answer.size() == 1 && selection.explained() &&
         selection.answer.size() == 1 && built.answer[0].is(selection.answer[0].placed);
}

/// Each cause of an answer at a place of its own: several at one place can bend to nearly any law.
bool apart(const std::vector<IdentifiedEffect>& answer) {
  for (std::size_t a = 0; a < answer.size(); ++a)
    for (std::size_t b = a + 1; b < answer.size(); ++b)
      if (answer[a].stage == answer[b].stage && answer[a].on == answer[b].on) return false;
  return true;
}

std::ptrdiff_t open_in(const std::vector<StageGap>& gaps) {
  return std::ranges::count_if(gaps, &StageGap::open);
}

/// Effects that either way cannot distinguish from the answer.
void add_indistinguishable(IdentifiedEffect& answer, const IdentifiedEffect& other) {
  for (const IdentifiedEffect& n : other.alternatives)
    if (std::ranges::none_of(answer.alternatives,
                             [&](const IdentifiedEffect& a) { return a.is(n.placed); }))
      answer.alternatives.push_back(n);
}

/// Gives the one effect of an answer the values and intervals of the joint estimate: with the zeros free, and with the
/// noise floor of the robot that has the effect. Least squares on the floor of the robot as described makes the size
/// of an effect that multiplies a noisy signal too small, and its interval too narrow (errors in variables). Returns
/// false, with `selection` as it was, where these values leave a stage open without the zeros that belong to them.
bool take_estimate(const Question& q, const IdentifiedEffect& estimated, Selection& selection) {
  const Problem& problem = q.problem;
  Evaluation evaluation = q.known.with(q.known.bare(), estimated.placed, problem.sets.all());
  auto left = unexplained_stages(problem, q.known, evaluation, problem.options.alone);
  if (any_open(left)) return false;
  const ShapleyValues gain = shapley_values(problem, q.known, {estimated.placed});
  IdentifiedEffect& answer = selection.answer[0];
  answer.placed = estimated.placed;
  answer.values = estimated.values, answer.intervals = estimated.intervals;
  answer.gain = gain.share[0], answer.gain_interval = gain.interval[0];
  selection.evaluation = std::move(evaluation), selection.left = std::move(left);
  return true;
}

/// Sorts the recordings anew by what this robot leaves of them; whether that changed anything.
using SortAgain = std::function<bool(const erp::Robot&)>;

/// Whether an answer of sim/gap/estimation needs no comparison with one of effects on the constants as given: it
/// explains, with one effect alone or with estimated constants; of a drive, whose friction is all at one
/// place, it leaves only noise.
bool stands(const Problem& problem, const JointEstimate& built) {
  if (problem.robot.drives.empty())
    return built.explained() && (!built.exact || built.answer.size() == 1);
  const double noise = problem.options.together.excess;
  return built.explained() &&
         std::ranges::all_of(built.left, [&](const StageGap& g) { return g.excess < noise; });
}

/// The robot as built first, unless the effects alone explain as well or better. False: nothing explains so far,
/// and the recordings were sorted anew.
bool answer(const Question& q, const SortAgain& sort_again, Diagnosis& d) {
  const Problem& problem = q.problem;
  const bool coarse = !q.detected.sensors.empty();
  Selection selection =
      select(problem, q.known, d.stages, coarse ? Depth::full : Depth::best_alone);
  std::optional<JointEstimate> built;
  if (leaves_noise_on_large_robot(problem, selection)) {
    if (selection.answer.size() == 1)
      take_estimate(q, estimated(problem, q.robot, selection.answer[0]), selection);
  } else if (selection.gap && selection.shown && !(coarse && selection.explained()))
    built.emplace(estimate_jointly(problem, q.robot, q.plain, selection.answer));
  if (built && agree(*built, selection)) {
    add_indistinguishable(selection.answer[0], built->answer[0]);
    if (take_estimate(q, built->answer[0], selection)) built.reset();
    else built->answer[0].alternatives = selection.answer[0].alternatives;
  } else if (built && !built->explained() && !selection.explained() && sort_again(built->robot)) {
    return false;
  } else if (built && built->unknown_law) {
    if (selection.explained()) built.reset();  // by one effect
  } else if (built && !stands(problem, *built)) {
    selection = select(problem, q.known, d.stages, Depth::full, std::move(selection));
    const bool leaves_less = open_in(built->left) < open_in(selection.left);
    if (selection.explained() || !leaves_less || !apart(built->answer)) built.reset();
  }
  if (built) conclude(q, *built, std::move(selection), d);
  else conclude(q, selection, d);
  return true;
}

/// The robot with what was seen without a fit.
erp::Robot as_detected(const erp::Robot& robot, const Detected& detected) {
  erp::Robot known = robot;
  for (const IdentifiedEffect& n : detected.sensors)
    known.effects.push_back(effects::written(n.placed));
  return known;
}

/// Of recordings that are sorted, and of what was cut in two for that. `plain`: of the robot as given. None where they
/// were sorted anew.
std::optional<Diagnosis> diagnosed(Problem& problem, const Evaluator& plain,
                                   const CutRecordings& cut, const SortAgain& sort_again) {
  const erp::Robot& robot = problem.robot;
  Diagnosis d;
  d.recordings = names_of(problem, problem.sets.all());
  d.shared = cut.shared, d.warnings = cut.warnings;
  if (problem.sets.held_out.empty()) {
    problem.sets.held_out = problem.sets.train;
    d.warnings.emplace_back(
        problem.sets.train.size() == 1
            ? "one recording only, and it was not split: an effect cannot be judged on the data "
              "that it was fitted to; record another"
            : "no recording is held out: an effect cannot be judged on the data that it was fitted "
              "to; name fewer in --train");
  }
  d.train = names_of(problem, problem.sets.train);
  d.held_out = names_of(problem, problem.sets.held_out);
  d.stages = localize(plain, plain.bare(), problem.sets.all(), problem.localization_options());

  const Detected detected = detect_directly(problem, plain);
  const erp::Robot known = as_detected(robot, detected);
  std::optional<Evaluator> coarse;
  if (!detected.sensors.empty()) coarse.emplace(known, problem.episodes, problem.options.seed);
  const Question question{problem, known, plain, coarse ? *coarse : plain, detected};
  warn_not_evaluated(problem, detected, d);
  if (!answer(question, sort_again, d)) return std::nullopt;
  drop_alternatives_at_bounds(d.answer);
  require_determined(d);
  require_sampling(plain, d);
  return d;
}

}  // namespace

const char* word(Verdict verdict) {
  constexpr const char* words[] = {"no_gap", "supported", "none_of_the_known", "not_identifiable"};
  return words[static_cast<std::size_t>(verdict)];
}

Diagnosis diagnose(const erp::Robot& robot, std::vector<residuals::Episode> episodes,
                   const DiagnoseOptions& options) {
  if (episodes.empty()) throw std::invalid_argument("no recording");
  Problem problem{robot, std::move(episodes), options, {}};
  problem.sets = first_sets(problem);
  problem.tell("residuals", 0.05);
  const auto evaluator = [&](const erp::Robot& of) {
    return Evaluator(of, problem.episodes, options.seed);
  };
  CutRecordings cut;
  std::optional<Evaluator> plain(evaluator(robot));
  if (split_by_residual(problem, *plain, cut)) plain.emplace(evaluator(robot));
  std::optional<Diagnosis> d = diagnosed(problem, *plain, cut, [&](const erp::Robot& built) {
    return split_by_residual(problem, evaluator(built), cut);
  });
  if (!d) {
    plain.emplace(evaluator(robot));
    d = diagnosed(problem, *plain, cut, [](const erp::Robot&) { return false; });
  }
  problem.tell("done", 1);
  return std::move(*d);
}

}  // namespace sim::diagnosis

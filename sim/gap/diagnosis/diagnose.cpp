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

/// Names of recordings, each once: a split recording is two episodes.
std::vector<std::string> names_of(const Problem& problem, const std::vector<std::size_t>& set) {
  std::vector<std::string> names;
  for (const std::size_t k : set)
    if (std::ranges::count(names, problem.episodes[k].name) == 0)
      names.push_back(problem.episodes[k].name);
  return names;
}

/// Whether the best single effect leaves only noise on a robot for which the joint estimate takes many
/// minutes: its time grows with the square of the number of actuators.
bool leaves_noise_on_large_robot(const Problem& problem, const Selection& selection) {
  constexpr std::size_t large = 12;  // actuators; chosen
  constexpr double noise = 0.2;      // excess; chosen
  return problem.robot.actuators.size() > large && selection.explained() &&
         std::ranges::none_of(selection.left, [](const StageGap& g) { return g.excess > noise; });
}

/// Whether both found the same single effect, and it explains the gap.
bool agree(const JointEstimate& built, const Selection& selection) {
  return built.exact && built.answer.size() == 1 && selection.explained() &&
         selection.answer.size() == 1 && built.answer[0].is(selection.answer[0].placed);
}

/// Whether each cause of an answer has its own place: several at one place can fit nearly any law.
bool have_own_places(const std::vector<IdentifiedEffect>& answer) {
  for (std::size_t a = 0; a < answer.size(); ++a)
    for (std::size_t b = a + 1; b < answer.size(); ++b)
      if (answer[a].stage == answer[b].stage && answer[a].on == answer[b].on) return false;
  return true;
}

std::ptrdiff_t open_in(const std::vector<StageGap>& gaps) {
  return std::ranges::count_if(gaps, &StageGap::open);
}

/// Adds the effects that the other method cannot distinguish from the answer.
void add_indistinguishable(IdentifiedEffect& answer, const IdentifiedEffect& other) {
  for (const IdentifiedEffect& n : other.alternatives)
    if (std::ranges::none_of(answer.alternatives,
                             [&](const IdentifiedEffect& a) { return a.is(n.placed); }))
      answer.alternatives.push_back(n);
}

/// Replaces values and intervals of the single effect by those of the joint estimate, which fits the zeros too and uses
/// the noise floor of the robot with the effect. With the noise floor of the robot as described, least squares
/// underestimates an effect that multiplies a noisy signal, and its interval (errors in variables). Returns false and
/// keeps `selection` if these values leave a stage open without the fitted zeros.
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

/// Splits the recordings again by the residuals of this robot; returns whether the split changed.
using SplitAgain = std::function<bool(const erp::Robot&)>;

/// Whether a joint estimate is accepted without a search for several effects with constants as given: it explains the
/// gap with one effect, or with estimated constants. For a drive, whose friction is all at one place, it must leave only
/// noise.
bool is_sufficient(const Problem& problem, const JointEstimate& built) {
  if (problem.robot.drives.empty())
    return built.explained() && (!built.exact || built.answer.size() == 1);
  const double noise = problem.options.together.excess;
  return built.explained() &&
         std::ranges::all_of(built.left, [&](const StageGap& g) { return g.excess < noise; });
}

/// Finds the answer: the joint estimate, unless effects alone explain the gap as well or better. Returns false if
/// neither explains it and the recordings were split again.
bool answer(const Question& q, const SplitAgain& split_again, Diagnosis& d) {
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
  } else if (built && !built->explained() && !selection.explained() && split_again(built->robot)) {
    return false;
  } else if (built && built->unknown_law) {
    if (selection.explained()) built.reset();  // by one effect
  } else if (built && !is_sufficient(problem, *built)) {
    selection = select(problem, q.known, d.stages, Depth::full, std::move(selection));
    const bool leaves_less = open_in(built->left) < open_in(selection.left);
    if (selection.explained() || !leaves_less || !have_own_places(built->answer)) built.reset();
  }
  if (built) conclude(q, *built, std::move(selection), d);
  else conclude(q, selection, d);
  return true;
}

/// The robot with the directly detected effects on sensors.
erp::Robot as_detected(const erp::Robot& robot, const Detected& detected) {
  erp::Robot known = robot;
  for (const IdentifiedEffect& n : detected.sensors)
    known.effects.push_back(effects::written(n.placed));
  return known;
}

/// Diagnosis of recordings that are split into sets. `plain`: evaluator of the robot as given. Empty if the recordings
/// were split again.
std::optional<Diagnosis> diagnosed(Problem& problem, const Evaluator& plain,
                                   const CutRecordings& cut, const SplitAgain& split_again) {
  const erp::Robot& robot = problem.robot;
  Diagnosis d;
  d.recordings = names_of(problem, problem.sets.all());
  d.shared = cut.shared, d.warnings = cut.warnings;
  if (problem.sets.held_out.empty()) {
    problem.sets.held_out = problem.sets.train;
    d.warnings.emplace_back(
        problem.sets.train.size() == 1
            ? "there is only one recording, and it was not split: an effect cannot be evaluated on "
              "the "
              "data that it was fitted to; record another"
            : "no recording is held out: an effect cannot be evaluated on the data that it was "
              "fitted to; list fewer recordings in --train");
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
  if (!answer(question, split_again, d)) return std::nullopt;
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
  problem.report_progress("residuals", 0.05);
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
  problem.report_progress("done", 1);
  return std::move(*d);
}

}  // namespace sim::diagnosis

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

/// Names of recordings without duplicates. A split recording is two episodes.
std::vector<std::string> names_of(const Problem& problem, const std::vector<std::size_t>& set) {
  std::vector<std::string> names;
  for (const std::size_t k : set)
    if (std::ranges::count(names, problem.episodes[k].name) == 0)
      names.push_back(problem.episodes[k].name);
  return names;
}

/// Whether the best single effect leaves only noise on a robot with many actuators. The time of a
/// joint estimate grows with the square of their number.
bool leaves_noise_on_large_robot(const Problem& problem, const Selection& selection) {
  constexpr std::size_t many_actuators = 12;  // chosen
  constexpr double noise_excess = 0.2;        // chosen
  return problem.robot.actuators.size() > many_actuators && selection.explained() &&
         std::ranges::none_of(selection.remaining,
                              [](const StageGap& g) { return g.excess > noise_excess; });
}

/// Whether both methods found the same single effect, and it explains the gap.
bool agree(const JointEstimate& built, const Selection& selection) {
  return built.exact && built.answer.size() == 1 && selection.explained() &&
         selection.answer.size() == 1 && built.answer[0].is(selection.answer[0].placed);
}

/// Whether all causes of an answer have different places. Several causes at one place can fit
/// nearly any law.
bool have_different_places(const std::vector<IdentifiedEffect>& answer) {
  for (std::size_t a = 0; a < answer.size(); ++a)
    for (std::size_t b = a + 1; b < answer.size(); ++b)
      if (answer[a].stage == answer[b].stage && answer[a].on == answer[b].on) return false;
  return true;
}

std::ptrdiff_t count_open(const std::vector<StageGap>& gaps) {
  return std::ranges::count_if(gaps, &StageGap::open);
}

/// Adds the effects that the other method cannot distinguish from the answer.
void add_indistinguishable(IdentifiedEffect& answer, const IdentifiedEffect& other) {
  for (const IdentifiedEffect& n : other.alternatives)
    if (std::ranges::none_of(answer.alternatives,
                             [&](const IdentifiedEffect& a) { return a.is(n.placed); }))
      answer.alternatives.push_back(n);
}

/// Replaces values and intervals of the single effect by those of the joint estimate. The joint
/// estimate fits the zeros too and uses the noise floor of the robot with the effect. With the
/// noise floor of the robot as described, least squares underestimates an effect that multiplies a
/// noisy signal, and its interval (errors in variables). Returns false and does not change
/// `selection` if these values leave a stage open without the fitted zeros.
bool use_estimate(const Question& q, const IdentifiedEffect& estimated, Selection& selection) {
  const Problem& problem = q.problem;
  Evaluation evaluation =
      q.corrected.with(q.corrected.nominal_evaluation(), estimated.placed, problem.sets.all());
  auto remaining = unexplained_stages(problem, q.corrected, evaluation, problem.options.single);
  if (any_open(remaining)) return false;
  const ShapleyValues gain = shapley_values(problem, q.corrected, {estimated.placed});
  IdentifiedEffect& answer = selection.answer[0];
  answer.placed = estimated.placed;
  answer.values = estimated.values, answer.intervals = estimated.intervals;
  answer.gain = gain.share[0], answer.gain_interval = gain.interval[0];
  selection.evaluation = std::move(evaluation), selection.remaining = std::move(remaining);
  return true;
}

/// Splits the recordings again by the residuals of a robot. Returns whether the split changed.
using SplitAgain = std::function<bool(const erp::Robot&)>;

/// Whether a joint estimate is accepted without a search for several effects with the given
/// constants: it explains the gap with one effect, or with estimated constants. For a drive it must
/// leave only noise, because its whole friction is at one place.
bool is_sufficient(const Problem& problem, const JointEstimate& built) {
  if (problem.robot.drives.empty())
    return built.explained() && (!built.exact || built.answer.size() == 1);
  const double noise = problem.options.effect_set.excess;
  return built.explained() &&
         std::ranges::all_of(built.remaining, [&](const StageGap& g) { return g.excess < noise; });
}

/// Finds the answer: the joint estimate, unless effects alone explain the gap equally well or
/// better. Returns false if neither explains it and the recordings were split again.
bool answer(const Question& q, const SplitAgain& split_again, Diagnosis& d) {
  const Problem& problem = q.problem;
  const bool has_coarse_sensors = !q.detected.sensors.empty();
  Selection selection =
      select(problem, q.corrected, d.stages, has_coarse_sensors ? Depth::full : Depth::best_single);
  std::optional<JointEstimate> built;
  if (leaves_noise_on_large_robot(problem, selection)) {
    if (selection.answer.size() == 1)
      use_estimate(q, estimated(problem, q.robot, selection.answer[0]), selection);
  } else if (selection.gap && selection.is_visible &&
             !(has_coarse_sensors && selection.explained()))
    built.emplace(estimate_jointly(problem, q.robot, q.baseline, selection.answer));
  if (built && agree(*built, selection)) {
    add_indistinguishable(selection.answer[0], built->answer[0]);
    if (use_estimate(q, built->answer[0], selection)) built.reset();
    else built->answer[0].alternatives = selection.answer[0].alternatives;
  } else if (built && !built->explained() && !selection.explained() && split_again(built->robot)) {
    return false;
  } else if (built && built->unknown_law) {
    if (selection.explained()) built.reset();  // one effect explains the gap
  } else if (built && !is_sufficient(problem, *built)) {
    selection = select(problem, q.corrected, d.stages, Depth::full, std::move(selection));
    const bool leaves_less = count_open(built->remaining) < count_open(selection.remaining);
    if (selection.explained() || !leaves_less || !have_different_places(built->answer))
      built.reset();
  }
  if (built) conclude(q, *built, std::move(selection), d);
  else conclude(q, selection, d);
  return true;
}

/// The robot with the directly detected effects on sensors.
erp::Robot as_detected(const erp::Robot& robot, const Detected& detected) {
  erp::Robot corrected = robot;
  for (const IdentifiedEffect& n : detected.sensors)
    corrected.effects.push_back(effects::written(n.placed));
  return corrected;
}

/// Diagnosis of recordings that are split into sets. `baseline`: evaluator of the given robot.
/// Empty if the recordings were split again.
std::optional<Diagnosis> diagnosed(Problem& problem, const Evaluator& baseline,
                                   const CutRecordings& cut, const SplitAgain& split_again) {
  const erp::Robot& robot = problem.robot;
  Diagnosis d;
  d.recordings = names_of(problem, problem.sets.all());
  d.split_recordings = cut.split_recordings, d.warnings = cut.warnings;
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
  d.stages = localize(baseline, baseline.nominal_evaluation(), problem.sets.all(),
                      problem.localization_options());

  const Detected detected = detect_directly(problem, baseline);
  const erp::Robot corrected = as_detected(robot, detected);
  std::optional<Evaluator> coarse;
  if (!detected.sensors.empty()) coarse.emplace(corrected, problem.episodes, problem.options.seed);
  const Question question{problem, corrected, baseline, coarse ? *coarse : baseline, detected};
  warn_not_evaluated(problem, detected, d);
  if (!answer(question, split_again, d)) return std::nullopt;
  remove_alternatives_at_bounds(d.answer);
  require_determined(d);
  require_sampling(baseline, d);
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
  const auto evaluator = [&](const erp::Robot& evaluated) {
    return Evaluator(evaluated, problem.episodes, options.seed);
  };
  CutRecordings cut;
  std::optional<Evaluator> baseline(evaluator(robot));
  if (split_by_residual(problem, *baseline, cut)) baseline.emplace(evaluator(robot));
  std::optional<Diagnosis> d = diagnosed(problem, *baseline, cut, [&](const erp::Robot& built) {
    return split_by_residual(problem, evaluator(built), cut);
  });
  if (!d) {
    baseline.emplace(evaluator(robot));
    d = diagnosed(problem, *baseline, cut, [](const erp::Robot&) { return false; });
  }
  problem.report_progress("done", 1);
  return std::move(*d);
}

}  // namespace sim::diagnosis

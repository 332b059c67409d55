#include "sim/gap/diagnosis/selection.hpp"

#include <algorithm>
#include <cmath>

#include "sim/gap/diagnosis/effect_set.hpp"
#include "sim/gap/diagnosis/shapley.hpp"

namespace sim::diagnosis {
namespace {

using effects::Placed;

/// Change of the residuals by one candidate.
struct Change {
  std::vector<double> z;          ///< Δz of every window
  std::vector<double> square_at;  ///< Σ Δz² by stage
  double square = 0;
};

Change change_of(const Problem& problem, const Evaluator& evaluator,
                 const std::vector<StageGap>& stages, const Evaluation& with) {
  Change change{{}, std::vector<double>(stages.size(), 0.0)};
  for (const std::size_t e : problem.sets.held_out) {
    const auto before = evaluator.whitened(evaluator.nominal_evaluation(), e),
               after = evaluator.whitened(with, e);
    std::size_t at = 0;
    for (const residuals::Residual& r : evaluator.nominal_evaluation().of_episode[e].residuals) {
      const auto stage = std::size_t(find_stage(stages, r.stage, r.on) - stages.begin());
      for (std::size_t n = 0; n < r.value.size(); ++n, ++at) {
        const double d = std::isnan(before[at]) ? 0 : after[at] - before[at];
        change.z.push_back(d), change.square += d * d;
        change.square_at[stage] += d * d;
      }
    }
  }
  return change;
}

/// Sets `signature` and `similarity` of each candidate from its change on the held-out recordings.
/// Clears the evaluations of `ranked`, which are large.
void compute_signatures(const Problem& problem, const Evaluator& evaluator,
                        const std::vector<StageGap>& stages, std::vector<Ranked>& ranked,
                        std::vector<IdentifiedEffect>& names) {
  Change first;
  for (std::size_t k = 0; k < ranked.size(); ++k) {
    Change change = change_of(problem, evaluator, stages, ranked[k].on_held_out);
    ranked[k].on_held_out = {};
    if (k == 0) first = change;
    double dot = 0;
    for (std::size_t n = 0; n < first.z.size(); ++n) dot += first.z[n] * change.z[n];
    names[k].similarity = dot / std::max(std::sqrt(first.square * change.square), 1e-12);
    for (double& s : change.square_at) s /= std::max(change.square, 1e-12);
    names[k].signature = std::move(change.square_at);
  }
}

/// Effects indistinguishable from the k-th of several.
std::vector<IdentifiedEffect> alternatives(const Problem& problem, const Evaluator& evaluator,
                                           const EffectSet& chosen_set, std::size_t k) {
  const Placed& chosen = chosen_set.chosen()[k];
  const Evaluation without =
      evaluator.with(without_element(chosen_set.chosen(), k), problem.sets.all());
  const auto ranked = rank(evaluator, without, problem.ranking_options(0.85, 0.95));
  if (ranked.empty() || ranked[0].fit.placed.on != chosen.on) return {};
  auto same = confusable(ranked, problem.ranking_options());
  same.push_back(0);
  std::vector<IdentifiedEffect> all;
  for (const std::size_t n : same)
    if (const IdentifiedEffect other = identified(ranked[n], problem.options.least_gain);
        !other.is(chosen))
      all.push_back(other);
  return all;
}

/// Sets the answer to several effects with their Shapley values and, if they explain the gap, their
/// alternatives.
void set_answer(const Problem& problem, const Evaluator& evaluator, const EffectSet& chosen_set,
                Selection& selection) {
  const ShapleyValues values = shapley_values(problem, evaluator, chosen_set.chosen());
  selection.interaction = values.interaction;
  selection.answer.clear();
  for (std::size_t k = 0; k < chosen_set.size(); ++k) {
    Ranked r{chosen_set.fits()[k], {}, {}, values.share[k], values.interval[k], 0};
    selection.answer.push_back(identified(r, 0));
    selection.answer.back().supported = values.lost[k].low > 0;
    if (selection.explained())
      selection.answer.back().alternatives = alternatives(problem, evaluator, chosen_set, k);
  }
  std::ranges::stable_sort(selection.answer, std::greater(), &IdentifiedEffect::gain);
}

/// The best single effect, and further effects while a stage is open.
EffectSet forward_selection(const Problem& problem, const Evaluator& evaluator,
                            const Placed& first) {
  EffectSet chosen_set(problem, evaluator, {first});
  while (chosen_set.leaves_unexplained(problem.options.search) &&
         chosen_set.size() < problem.options.most_effects)
    if (!chosen_set.add_another()) break;
  chosen_set.remove_unnecessary();
  return chosen_set;
}

/// Ranks individually fitted effects.
void rank_single(const Problem& problem, const Evaluator& evaluator,
                 const std::vector<StageGap>& stages, Selection& s) {
  auto ranking = problem.ranking_options(0.1, 0.5);
  ranking.stages = s.remaining;
  s.single_fits = rank(evaluator, evaluator.nominal_evaluation(), ranking);
  for (const Ranked& r : s.single_fits)
    s.ranked.push_back(identified(r, problem.options.least_gain));
  compute_signatures(problem, evaluator, stages, s.single_fits, s.ranked);
  control_discoveries(s.single_fits, s.ranked);
}

}  // namespace

bool Selection::explained() const { return !answer.empty() && !any_open(remaining); }

Selection select(const Problem& problem, const Evaluator& evaluator,
                 const std::vector<StageGap>& stages, Depth depth, Selection earlier) {
  Selection s{.remaining = localize(evaluator, evaluator.nominal_evaluation(),
                                    problem.sets.held_out, problem.localization_options()),
              .evaluation = evaluator.nominal_evaluation()};
  s.gap = any_open(localize(evaluator, evaluator.nominal_evaluation(), problem.sets.all(),
                            problem.localization_options()));
  if (!s.gap) return s;
  if (earlier.single_fits.empty()) rank_single(problem, evaluator, stages, s);
  else s.single_fits = std::move(earlier.single_fits), s.ranked = std::move(earlier.ranked);
  const std::vector<Ranked>& first = s.single_fits;
  s.is_visible = any_open(s.remaining);
  if (first.empty() || !s.is_visible) return s;
  if (!s.ranked[0].supported) {
    const Evaluation best =
        evaluator.with(evaluator.nominal_evaluation(), first[0].fit.placed, problem.sets.held_out);
    s.is_visible = any_open(unexplained_stages(problem, evaluator, best, problem.options.single));
    return s;
  }
  s.answer = {s.ranked[0]};
  if (depth == Depth::best_single) {
    s.evaluation =
        evaluator.with(evaluator.nominal_evaluation(), first[0].fit.placed, problem.sets.all());
    s.remaining = unexplained_stages(problem, evaluator, s.evaluation, problem.options.single);
    for (const std::size_t k : confusable(first, problem.ranking_options()))
      s.answer[0].alternatives.push_back(s.ranked[k]);
    return s;
  }
  const DiagnoseOptions& options = problem.options;
  EffectSet chosen_set = forward_selection(problem, evaluator, first[0].fit.placed);
  const bool unexplained_stages =
      chosen_set.leaves_unexplained(chosen_set.size() == 1 ? options.single : options.effect_set);
  if (unexplained_stages || chosen_set.size() > 1)
    if (auto batch = same_type_on_open_actuators(problem, evaluator, first))
      if (unexplained_stages ||
          (batch->size() <= chosen_set.size() && batch->square() < chosen_set.square()))
        chosen_set = std::move(*batch);
  const bool is_single = chosen_set.size() == 1;
  s.remaining = chosen_set.remaining(is_single ? options.single : options.effect_set);
  if (!is_single || !s.answer[0].is(chosen_set.chosen()[0]))
    set_answer(problem, evaluator, chosen_set, s);
  else
    for (const std::size_t k : confusable(first, problem.ranking_options()))
      s.answer[0].alternatives.push_back(s.ranked[k]);
  s.evaluation = chosen_set.evaluation();
  return s;
}

}  // namespace sim::diagnosis

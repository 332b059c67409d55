#include "sim/gap/diagnosis/selection.hpp"

#include <algorithm>

#include "sim/gap/diagnosis/shares.hpp"
#include "sim/gap/diagnosis/signature.hpp"
#include "sim/gap/diagnosis/together.hpp"

namespace sim::diagnosis {
namespace {

using effects::Placed;

/// What could stand for one of several effects as well.
std::vector<Named> alternatives(const Evidence& evidence, const Trials& trials,
                                const Together& together, std::size_t k) {
  const Placed& chosen = together.chosen()[k];
  const Trial without = trials.with(all_but(together.chosen(), k), evidence.sets.all());
  const auto ranked = rank(trials, without, evidence.which_options(0.85, 0.95));
  if (ranked.empty() || ranked[0].fit.placed.on != chosen.on) return {};
  auto same = confusable(ranked, evidence.which_options());
  same.push_back(0);
  std::vector<Named> all;
  for (const std::size_t n : same)
    if (const Named other = named(ranked[n], evidence.options.least_gain); !other.is(chosen))
      all.push_back(other);
  return all;
}

/// Several effects: each with its share of what they close together; where they explain, with what could stand for it.
void settle(const Evidence& evidence, const Trials& trials, const Together& together,
            Selection& selection) {
  const Shares part = shares(evidence, trials, together.chosen());
  selection.interaction = part.interaction;
  selection.answer.clear();
  for (std::size_t k = 0; k < together.size(); ++k) {
    Ranked r{together.fits()[k], {}, {}, part.share[k], part.interval[k], 0};
    selection.answer.push_back(named(r, 0));
    selection.answer.back().supported = part.lost[k].low > 0;
    if (selection.explained())
      selection.answer.back().alternatives = alternatives(evidence, trials, together, k);
  }
  std::ranges::stable_sort(selection.answer, std::greater(), &Named::gain);
}

/// The best alone, others on top of it while a stage stays open.
Together one_after_another(const Evidence& evidence, const Trials& trials, const Placed& first) {
  Together together(evidence, trials, {first});
  while (together.leave_open(evidence.options.search) &&
         together.size() < evidence.options.most_effects)
    if (!together.add_another()) break;
  together.drop_superfluous();
  return together;
}

/// Every effect alone, the best first.
void rank_alone(const Evidence& evidence, const Trials& trials, const std::vector<StageGap>& stages,
                Selection& s) {
  auto which = evidence.which_options(0.1, 0.5);
  which.stages = s.left;
  s.alone = rank(trials, trials.bare(), which);
  for (const Ranked& r : s.alone) s.ranked.push_back(named(r, evidence.options.least_gain));
  sign(evidence, trials, stages, s.alone, s.ranked);
  control_discoveries(s.alone, s.ranked);
}

}  // namespace

bool Selection::explained() const { return !answer.empty() && !any_open(left); }

Selection select(const Evidence& evidence, const Trials& trials,
                 const std::vector<StageGap>& stages, Depth depth, Selection earlier) {
  Selection s{
      .left = where(trials, trials.bare(), evidence.sets.held_out, evidence.where_options()),
      .trial = trials.bare()};
  s.gap = any_open(where(trials, trials.bare(), evidence.sets.all(), evidence.where_options()));
  if (!s.gap) return s;
  if (earlier.alone.empty()) rank_alone(evidence, trials, stages, s);
  else s.alone = std::move(earlier.alone), s.ranked = std::move(earlier.ranked);
  const std::vector<Ranked>& first = s.alone;
  s.shown = any_open(s.left);
  if (first.empty() || !s.shown) return s;
  if (!s.ranked[0].supported) {
    const Trial best = trials.with(trials.bare(), first[0].fit.placed, evidence.sets.held_out);
    s.shown = any_open(left_open(evidence, trials, best, evidence.options.alone));
    return s;
  }
  s.answer = {s.ranked[0]};
  if (depth == Depth::best_alone) {
    s.trial = trials.with(trials.bare(), first[0].fit.placed, evidence.sets.all());
    s.left = left_open(evidence, trials, s.trial, evidence.options.alone);
    for (const std::size_t k : confusable(first, evidence.which_options()))
      s.answer[0].alternatives.push_back(s.ranked[k]);
    return s;
  }
  const DiagnoseOptions& options = evidence.options;
  Together together = one_after_another(evidence, trials, first[0].fit.placed);
  const bool left_open =
      together.leave_open(together.size() == 1 ? options.alone : options.together);
  if (left_open || together.size() > 1)
    if (auto batch = of_one_batch(evidence, trials, first))
      if (left_open || (batch->size() <= together.size() && batch->square() < together.square()))
        together = std::move(*batch);
  const bool one = together.size() == 1;
  s.left = together.left(one ? options.alone : options.together);
  if (!one || !s.answer[0].is(together.chosen()[0])) settle(evidence, trials, together, s);
  else
    for (const std::size_t k : confusable(first, evidence.which_options()))
      s.answer[0].alternatives.push_back(s.ranked[k]);
  s.trial = together.trial();
  return s;
}

}  // namespace sim::diagnosis

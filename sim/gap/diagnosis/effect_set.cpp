#include "sim/gap/diagnosis/effect_set.hpp"

#include <algorithm>
#include <optional>

#include "interfaces/parallel/in_parallel.hpp"
#include "sim/gap/diagnosis/screening.hpp"
#include "sim/gap/diagnosis/selection.hpp"

namespace sim::diagnosis {

using effects::Placed;

std::vector<Placed> without_element(std::vector<Placed> all, std::size_t k) {
  all.erase(all.begin() + static_cast<std::ptrdiff_t>(k));
  return all;
}

bool any_open(const std::vector<StageGap>& gaps) {
  return std::ranges::any_of(gaps, &StageGap::open);
}

EffectSet::EffectSet(const Problem& problem, const Evaluator& evaluator, std::vector<Placed> all)
    : problem_(problem), evaluator_(evaluator), chosen_(std::move(all)) {
  evaluation_ = evaluator.with(chosen_, sets().all());
}

std::vector<StageGap> EffectSet::remaining(const Tolerance& tolerance) const {
  return unexplained_stages(problem_, evaluator_, evaluation_, tolerance);
}

bool EffectSet::leaves_unexplained(const Tolerance& tolerance) const {
  return any_open(remaining(tolerance));
}

double EffectSet::square() const {
  return sum(evaluator_.get().blocks(evaluation_, sets().held_out)).square;
}

void EffectSet::refit() {
  fits_ = fit_jointly(evaluator_, chosen_, sets().train);
  for (std::size_t k = 0; k < chosen_.size(); ++k) chosen_[k] = fits_[k].placed;
  evaluation_ = evaluator_.get().with(chosen_, sets().all());
}

bool EffectSet::add_another() {
  constexpr std::size_t count = 6;  // of fitted candidates; chosen
  const Problem& problem = problem_;
  const double progress = 0.5 + 0.15 * static_cast<double>(size() - 1);
  const auto ranking = problem.ranking_options(progress, progress + 0.1);
  const auto candidates = best_screened(evaluator_, evaluation_, ranking, count);
  std::vector<std::optional<EffectSet>> joined(candidates.size());
  in_parallel(candidates.size(), ranking.threads, [&](std::size_t k) {
    if (has(candidates[k])) return;
    joined[k] = *this;
    joined[k]->chosen_.push_back(fit(evaluator_, evaluation_, candidates[k], sets().train).placed);
    joined[k]->refit();
  });
  std::erase(joined, std::nullopt);
  if (joined.empty()) return false;
  auto& best = *std::ranges::min_element(joined, {}, [](const auto& j) { return j->square(); });
  if (!best->helps(*this)) return false;
  *this = std::move(*best);
  for (std::size_t k = 0; k + 1 < chosen_.size(); ++k)
    reconsider(k, progress + 0.1, progress + 0.15);
  return true;
}

void EffectSet::remove_unnecessary() {
  for (std::size_t k = 0; size() > 1 && k < size();) {
    EffectSet others = *this;
    others.chosen_ = without_element(chosen_, k);
    others.refit();
    if (others.leaves_unexplained(problem_.get().options.effect_set)) ++k;
    else *this = std::move(others), k = 0;
  }
}

bool EffectSet::has(const Placed& other) const {
  return std::ranges::any_of(chosen_, [&](const Placed& p) { return identified(p).is(other); });
}

/// Whether the last effect removes half of the remaining excess of an open stage.
bool EffectSet::helps(const EffectSet& before) const {
  constexpr double smallest_relief = 0.5;  // chosen
  return relief(evaluator_, before.evaluation_, evaluation_, sets().held_out,
                before.remaining(problem_.get().options.search)) > smallest_relief;
}

/// Replaces effect k if another effect is better. An earlier choice may have been a compromise
/// between two effects.
void EffectSet::reconsider(std::size_t k, double progress_begin, double progress_end) {
  auto others = without_element(chosen_, k);
  const auto ranked = rank(evaluator_, evaluator_.get().with(others, sets().all()),
                           problem_.get().ranking_options(progress_begin, progress_end));
  if (ranked.empty() || identified(ranked[0].fit.placed).is(chosen_[k])) return;
  EffectSet other = *this;
  others.push_back(ranked[0].fit.placed);
  other.chosen_ = others;
  other.refit();
  if (other.square() < square()) *this = std::move(other);
}

namespace {

/// Actuators with an open stage.
std::vector<std::string> open_actuators(const Problem& problem, const Evaluator& evaluator) {
  const auto gaps = localize(evaluator, evaluator.nominal_evaluation(), problem.sets.all(),
                             problem.localization_options());
  std::vector<std::string> names;
  for (const erp::Actuator& actuator : problem.robot.actuators)
    if (std::ranges::any_of(gaps,
                            [&](const StageGap& g) { return g.open && g.on == actuator.name; }))
      names.push_back(actuator.name);
  return names;
}

/// Types of effects that relieve one of these actuators, the best first.
std::vector<effects::AnyEffect> types_of(const std::vector<Ranked>& ranked,
                                         const std::vector<std::string>& actuators) {
  constexpr std::size_t max_types = 10;  // chosen
  std::vector<effects::AnyEffect> types;
  for (const Ranked& r : ranked) {
    const effects::AnyEffect& effect = r.fit.placed.effect;
    if (types.size() < max_types && r.relieves() &&
        std::ranges::count(actuators, r.fit.placed.on) &&
        !std::ranges::count(types, effect.index(), &effects::AnyEffect::index))
      types.push_back(*effects::neutral(effects::about(effect).type));
  }
  return types;
}

}  // namespace

std::optional<EffectSet> same_type_on_open_actuators(const Problem& problem,
                                                     const Evaluator& evaluator,
                                                     const std::vector<Ranked>& ranked) {
  const auto actuators = open_actuators(problem, evaluator);
  if (actuators.size() < 2) return std::nullopt;
  const auto types = types_of(ranked, actuators);
  std::vector<std::optional<EffectSet>> fitted(types.size());
  in_parallel(types.size(), problem.options.threads, [&](std::size_t k) {
    std::vector<Placed> all;
    for (const std::string& on : actuators)
      all.push_back(
          fit(evaluator, evaluator.nominal_evaluation(), {on, types[k]}, problem.sets.train)
              .placed);
    fitted[k].emplace(problem, evaluator, std::move(all));
    fitted[k]->refit();
  });
  const auto best =
      std::ranges::min_element(fitted, {}, [](const auto& batch) { return batch->square(); });
  if (best == fitted.end() || (*best)->leaves_unexplained(problem.options.effect_set))
    return std::nullopt;
  return *best;
}

}  // namespace sim::diagnosis

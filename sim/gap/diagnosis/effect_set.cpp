#include "sim/gap/diagnosis/effect_set.hpp"

#include <algorithm>
#include <optional>

#include "interfaces/parallel/in_parallel.hpp"
#include "sim/gap/diagnosis/screening.hpp"
#include "sim/gap/diagnosis/selection.hpp"

namespace sim::diagnosis {

using effects::Placed;

std::vector<Placed> all_but(std::vector<Placed> all, std::size_t k) {
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

std::vector<StageGap> EffectSet::left(const Tolerance& tolerance) const {
  return unexplained_stages(problem_, evaluator_, evaluation_, tolerance);
}

bool EffectSet::leaves_unexplained(const Tolerance& tolerance) const {
  return any_open(left(tolerance));
}

double EffectSet::square() const {
  return sum(evaluator_.get().blocks(evaluation_, sets().held_out)).square;
}

void EffectSet::refit() {
  fits_ = fit_together(evaluator_, chosen_, sets().train);
  for (std::size_t k = 0; k < chosen_.size(); ++k) chosen_[k] = fits_[k].placed;
  evaluation_ = evaluator_.get().with(chosen_, sets().all());
}

bool EffectSet::add_another() {
  constexpr std::size_t count = 6;  // chosen
  const Problem& problem = problem_;
  const double done = 0.5 + 0.15 * static_cast<double>(size() - 1);
  const auto which = problem.ranking_options(done, done + 0.1);
  const auto more = best_screened(evaluator_, evaluation_, which, count);
  std::vector<std::optional<EffectSet>> joined(more.size());
  in_parallel(more.size(), which.threads, [&](std::size_t k) {
    if (has(more[k])) return;
    joined[k] = *this;
    joined[k]->chosen_.push_back(fit(evaluator_, evaluation_, more[k], sets().train).placed);
    joined[k]->refit();
  });
  std::erase(joined, std::nullopt);
  if (joined.empty()) return false;
  auto& best = *std::ranges::min_element(joined, {}, [](const auto& j) { return j->square(); });
  if (!best->helps(*this)) return false;
  *this = std::move(*best);
  for (std::size_t k = 0; k + 1 < chosen_.size(); ++k) reconsider(k, done + 0.1, done + 0.15);
  return true;
}

void EffectSet::drop_superfluous() {
  for (std::size_t k = 0; size() > 1 && k < size();) {
    EffectSet others = *this;
    others.chosen_ = all_but(chosen_, k);
    others.refit();
    if (others.leaves_unexplained(problem_.get().options.together)) ++k;
    else *this = std::move(others), k = 0;
  }
}

bool EffectSet::has(const Placed& other) const {
  return std::ranges::any_of(chosen_, [&](const Placed& p) { return identified(p).is(other); });
}

/// Whether it removes half of the remaining excess of an open stage.
bool EffectSet::helps(const EffectSet& before) const {
  constexpr double worth = 0.5;  // chosen
  return relief(evaluator_, before.evaluation_, evaluation_, sets().held_out,
                before.left(problem_.get().options.search)) > worth;
}

/// Replaces effect k if another is better now: an earlier choice may have been a compromise between two effects.
void EffectSet::reconsider(std::size_t k, double from, double to) {
  auto others = all_but(chosen_, k);
  const auto again = rank(evaluator_, evaluator_.get().with(others, sets().all()),
                          problem_.get().ranking_options(from, to));
  if (again.empty() || identified(again[0].fit.placed).is(chosen_[k])) return;
  EffectSet other = *this;
  others.push_back(again[0].fit.placed);
  other.chosen_ = others;
  other.refit();
  if (other.square() < square()) *this = std::move(other);
}

namespace {

/// Actuators with an open stage.
std::vector<std::string> open_actuators(const Problem& problem, const Evaluator& evaluator) {
  const auto gaps =
      localize(evaluator, evaluator.bare(), problem.sets.all(), problem.localization_options());
  std::vector<std::string> names;
  for (const erp::Actuator& actuator : problem.robot.actuators)
    if (std::ranges::any_of(gaps,
                            [&](const StageGap& g) { return g.open && g.on == actuator.name; }))
      names.push_back(actuator.name);
  return names;
}

/// Types of effects that relieve one of these actuators, best first.
std::vector<effects::AnyEffect> types_of(const std::vector<Ranked>& ranked,
                                         const std::vector<std::string>& actuators) {
  constexpr std::size_t most = 10;  // chosen
  std::vector<effects::AnyEffect> types;
  for (const Ranked& r : ranked) {
    const effects::AnyEffect& effect = r.fit.placed.effect;
    if (types.size() < most && r.relieves() && std::ranges::count(actuators, r.fit.placed.on) &&
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
      all.push_back(fit(evaluator, evaluator.bare(), {on, types[k]}, problem.sets.train).placed);
    fitted[k].emplace(problem, evaluator, std::move(all));
    fitted[k]->refit();
  });
  const auto best =
      std::ranges::min_element(fitted, {}, [](const auto& batch) { return batch->square(); });
  if (best == fitted.end() || (*best)->leaves_unexplained(problem.options.together))
    return std::nullopt;
  return *best;
}

}  // namespace sim::diagnosis

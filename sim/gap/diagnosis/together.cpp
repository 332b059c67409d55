#include "sim/gap/diagnosis/together.hpp"

#include <algorithm>
#include <optional>

#include "sim/gap/diagnosis/promise.hpp"
#include "sim/gap/diagnosis/selection.hpp"
#include "interfaces/parallel/in_parallel.hpp"

namespace sim::diagnosis {

using effects::Placed;

std::vector<Placed> all_but(std::vector<Placed> all, std::size_t k) {
  all.erase(all.begin() + static_cast<std::ptrdiff_t>(k));
  return all;
}

bool any_open(const std::vector<StageGap>& gaps) {
  return std::ranges::any_of(gaps, &StageGap::open);
}

Together::Together(const Evidence& evidence, const Trials& trials, std::vector<Placed> all)
    : evidence_(evidence), trials_(trials), chosen_(std::move(all)) {
  trial_ = trials.with(chosen_, sets().all());
}

std::vector<StageGap> Together::left(const Tolerance& tolerance) const {
  return left_open(evidence_, trials_, trial_, tolerance);
}

bool Together::leave_open(const Tolerance& tolerance) const { return any_open(left(tolerance)); }

double Together::square() const {
  return sum(trials_.get().blocks(trial_, sets().held_out)).square;
}

void Together::refit() {
  fits_ = fit_together(trials_, chosen_, sets().train);
  for (std::size_t k = 0; k < chosen_.size(); ++k) chosen_[k] = fits_[k].placed;
  trial_ = trials_.get().with(chosen_, sets().all());
}

bool Together::add_another() {
  constexpr std::size_t tried_together = 6;  // chosen
  const Evidence& evidence = evidence_;
  const double done = 0.5 + 0.15 * static_cast<double>(size() - 1);
  const auto which = evidence.which_options(done, done + 0.1);
  const auto more = most_promising(trials_, trial_, which, tried_together);
  std::vector<std::optional<Together>> joined(more.size());
  in_parallel(more.size(), which.threads, [&](std::size_t k) {
    if (has(more[k])) return;
    joined[k] = *this;
    joined[k]->chosen_.push_back(fit(trials_, trial_, more[k], sets().train).placed);
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

void Together::drop_superfluous() {
  for (std::size_t k = 0; size() > 1 && k < size();) {
    Together others = *this;
    others.chosen_ = all_but(chosen_, k);
    others.refit();
    if (others.leave_open(evidence_.get().options.together)) ++k;
    else *this = std::move(others), k = 0;
  }
}

bool Together::has(const Placed& other) const {
  return std::ranges::any_of(chosen_, [&](const Placed& p) { return named(p).is(other); });
}

/// It takes away half of what was left at a stage that was open.
bool Together::helps(const Together& before) const {
  constexpr double worth = 0.5;  // chosen
  return relief(trials_, before.trial_, trial_, sets().held_out,
                before.left(evidence_.get().options.search)) > worth;
}

/// An earlier choice may have been a compromise between two.
void Together::reconsider(std::size_t k, double from, double to) {
  auto others = all_but(chosen_, k);
  const auto again = rank(trials_, trials_.get().with(others, sets().all()),
                          evidence_.get().which_options(from, to));
  if (again.empty() || named(again[0].fit.placed).is(chosen_[k])) return;
  Together other = *this;
  others.push_back(again[0].fit.placed);
  other.chosen_ = others;
  other.refit();
  if (other.square() < square()) *this = std::move(other);
}

namespace {

/// Actuators of which a stage is open.
std::vector<std::string> that_differ(const Evidence& evidence, const Trials& trials) {
  const auto gaps = where(trials, trials.bare(), evidence.sets.all(), evidence.where_options());
  std::vector<std::string> names;
  for (const erp::Actuator& actuator : evidence.robot.actuators)
    if (std::ranges::any_of(gaps,
                            [&](const StageGap& g) { return g.open && g.on == actuator.name; }))
      names.push_back(actuator.name);
  return names;
}

/// Of actuators, the kinds of effect that relieve one of them, the best first.
std::vector<effects::AnyEffect> kinds_of(const std::vector<Ranked>& ranked,
                                         const std::vector<std::string>& actuators) {
  constexpr std::size_t most = 10;  // chosen
  std::vector<effects::AnyEffect> kinds;
  for (const Ranked& r : ranked) {
    const effects::AnyEffect& effect = r.fit.placed.effect;
    if (kinds.size() < most && r.relieves() && std::ranges::count(actuators, r.fit.placed.on) &&
        !std::ranges::count(kinds, effect.index(), &effects::AnyEffect::index))
      kinds.push_back(*effects::neutral(effects::about(effect).type));
  }
  return kinds;
}

}  // namespace

std::optional<Together> of_one_batch(const Evidence& evidence, const Trials& trials,
                                     const std::vector<Ranked>& ranked) {
  const auto actuators = that_differ(evidence, trials);
  if (actuators.size() < 2) return std::nullopt;
  const auto kinds = kinds_of(ranked, actuators);
  std::vector<std::optional<Together>> tried(kinds.size());
  in_parallel(kinds.size(), evidence.options.threads, [&](std::size_t k) {
    std::vector<Placed> all;
    for (const std::string& on : actuators)
      all.push_back(fit(trials, trials.bare(), {on, kinds[k]}, evidence.sets.train).placed);
    tried[k].emplace(evidence, trials, std::move(all));
    tried[k]->refit();
  });
  const auto best =
      std::ranges::min_element(tried, {}, [](const auto& batch) { return batch->square(); });
  if (best == tried.end() || (*best)->leave_open(evidence.options.together)) return std::nullopt;
  return *best;
}

}  // namespace sim::diagnosis

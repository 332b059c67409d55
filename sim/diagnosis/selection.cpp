#include "sim/diagnosis/selection.hpp"

#include <algorithm>
#include <functional>
#include <optional>

#include "sim/diagnosis/promise.hpp"
#include "sim/diagnosis/shares.hpp"
#include "sim/diagnosis/signature.hpp"
#include "sim/parallel/in_parallel.hpp"

namespace sim::diagnosis {
namespace {

using effects::Placed;

bool any_open(const std::vector<StageGap>& gaps) {
  return std::ranges::any_of(gaps, &StageGap::open);
}

std::vector<Placed> all_but(std::vector<Placed> all, std::size_t k) {
  all.erase(all.begin() + static_cast<std::ptrdiff_t>(k));
  return all;
}

/// Effects that are tried together, on their way to the answer.
class Together {
 public:
  Together(const Evidence& evidence, const Trials& trials, const Placed& first)
      : evidence_(evidence), trials_(trials), chosen_{first} {
    trial_ = trials.with(trials.bare(), first, sets().all());
  }

  std::size_t size() const { return chosen_.size(); }
  const std::vector<Placed>& chosen() const { return chosen_; }
  const std::vector<Fit>& fits() const { return fits_; }
  Trial& trial() { return trial_; }
  std::vector<StageGap> left(const Tolerance& tolerance) const {
    return left_open(evidence_, trials_, trial_, tolerance);
  }

  /// Of the effects that promise most beside the others, the one that leaves least when all are
  /// fitted together, if it helps.
  bool add_another() {
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

  /// One goes that the others have made superfluous: without it no stage opens.
  void drop_superfluous() {
    for (std::size_t k = 0; size() > 1 && k < size();) {
      Together others = *this;
      others.chosen_ = all_but(chosen_, k);
      others.refit();
      if (any_open(others.left(evidence_.get().options.together))) ++k;
      else *this = std::move(others), k = 0;
    }
  }

 private:
  static constexpr std::size_t tried_together = 6;  // chosen
  const Sets& sets() const { return evidence_.get().sets; }
  bool has(const Placed& other) const {
    return std::ranges::any_of(chosen_, [&](const Placed& p) { return named(p).is(other); });
  }
  double square() const { return sum(trials_.get().blocks(trial_, sets().held_out)).square; }

  /// It takes away half of what was left at a stage that was open.
  bool helps(const Together& before) const {
    constexpr double worth = 0.5;  // chosen
    return relief(trials_, before.trial_, trial_, sets().held_out,
                  before.left(evidence_.get().options.search)) > worth;
  }

  /// An earlier choice may have been a compromise between two.
  void reconsider(std::size_t k, double from, double to) {
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

  void refit() {
    fits_ = fit_together(trials_, chosen_, sets().train);
    for (std::size_t k = 0; k < chosen_.size(); ++k) chosen_[k] = fits_[k].placed;
    trial_ = trials_.get().with(chosen_, sets().all());
  }

  std::reference_wrapper<const Evidence> evidence_;
  std::reference_wrapper<const Trials> trials_;
  std::vector<Placed> chosen_;
  std::vector<Fit> fits_;
  Trial trial_;
};

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

/// Several effects: each with its share of what they close together.
void settle(const Evidence& evidence, const Trials& trials, const Together& together,
            Selection& selection) {
  const Shares part = shares(evidence, trials, together.chosen());
  selection.interaction = part.interaction;
  selection.answer.clear();
  for (std::size_t k = 0; k < together.size(); ++k) {
    Ranked r{together.fits()[k], {}, {}, part.share[k], part.interval[k], 0};
    selection.answer.push_back(named(r, 0));
    selection.answer.back().supported = part.lost[k].low > 0;
    selection.answer.back().alike = alternatives(evidence, trials, together, k);
  }
  std::ranges::stable_sort(selection.answer, std::greater(), &Named::gain);
}

}  // namespace

bool Selection::explained() const { return !answer.empty() && !any_open(left); }

Selection select(const Evidence& evidence, const Trials& trials,
                 const std::vector<StageGap>& stages) {
  Selection s{
      .left = where(trials, trials.bare(), evidence.sets.held_out, evidence.where_options()),
      .trial = trials.bare()};
  auto which = evidence.which_options(0.1, 0.5);
  which.stages = s.left;
  s.gap = any_open(where(trials, trials.bare(), evidence.sets.all(), evidence.where_options()));
  if (!s.gap) return s;
  auto first = rank(trials, trials.bare(), which);
  for (const Ranked& r : first) s.ranked.push_back(named(r, evidence.options.least_gain));
  sign(evidence, trials, stages, first, s.ranked);
  control_discoveries(first, s.ranked);
  s.told = any_open(s.left);
  if (first.empty() || !s.told) return s;
  if (!s.ranked[0].supported) {
    const Trial alone = trials.with(trials.bare(), first[0].fit.placed, evidence.sets.held_out);
    s.told = any_open(left_open(evidence, trials, alone, evidence.options.alone));
    return s;
  }
  s.answer = {s.ranked[0]};
  Together together(evidence, trials, first[0].fit.placed);
  while (any_open(together.left(evidence.options.search)) &&
         together.size() < evidence.options.most_effects)
    if (!together.add_another()) break;
  together.drop_superfluous();
  const bool alone = together.size() == 1;
  if (!alone || !s.answer[0].is(together.chosen()[0])) settle(evidence, trials, together, s);
  else
    for (const std::size_t k : confusable(first, evidence.which_options()))
      s.answer[0].alike.push_back(s.ranked[k]);
  s.left = together.left(alone ? evidence.options.alone : evidence.options.together);
  s.trial = std::move(together.trial());
  return s;
}

}  // namespace sim::diagnosis

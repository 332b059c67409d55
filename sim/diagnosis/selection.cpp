#include "sim/diagnosis/selection.hpp"

#include <algorithm>

#include "sim/diagnosis/shares.hpp"
#include "sim/diagnosis/signature.hpp"

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
  std::vector<StageGap> left(bool alone) const {
    return left_open(evidence_, trials_, trial_, alone);
  }

  /// The best effect on top of the others, if it helps.
  bool add_another() {
    const double done = 0.5 + 0.15 * static_cast<double>(size() - 1);
    const auto more = rank(trials_, trial_, evidence_.which_options(done, done + 0.1));
    if (more.empty() || more[0].gain_interval.low < evidence_.options.least_gain ||
        !helps(more[0].fit.placed))
      return false;
    chosen_.push_back(more[0].fit.placed);
    refit();
    for (std::size_t k = 0; k + 1 < chosen_.size(); ++k) reconsider(k, done + 0.1, done + 0.15);
    return true;
  }

 private:
  const Sets& sets() const { return evidence_.sets; }
  double square() const { return sum(trials_.blocks(trial_, sets().held_out)).square; }

  /// It takes away half of what the others leave at a stage that is open.
  bool helps(const Placed& more) const {
    constexpr double worth = 0.5;  // chosen
    const auto after = where(trials_, trials_.with(trial_, more, sets().held_out), sets().held_out,
                             evidence_.where_options());
    return std::ranges::any_of(left(false), [&](const StageGap& b) {
      return b.open && find_stage(after, b.stage, b.on)->excess < (1 - worth) * b.excess;
    });
  }

  /// An earlier choice may have been a compromise between two.
  void reconsider(std::size_t k, double from, double to) {
    auto others = all_but(chosen_, k);
    const auto again =
        rank(trials_, trials_.with(others, sets().all()), evidence_.which_options(from, to));
    if (again.empty() || named(again[0].fit.placed).is(chosen_[k])) return;
    others.push_back(again[0].fit.placed);
    const auto kept = chosen_;
    const double was = square();
    chosen_ = others;
    refit();
    if (square() <= was) return;
    chosen_ = kept;
    refit();
  }

  void refit() {
    fits_ = fit_together(trials_, chosen_, sets().train);
    for (std::size_t k = 0; k < chosen_.size(); ++k) chosen_[k] = fits_[k].placed;
    trial_ = trials_.with(chosen_, sets().all());
  }

  const Evidence& evidence_;
  const Trials& trials_;
  std::vector<Placed> chosen_;
  std::vector<Fit> fits_;
  Trial trial_;
};

/// What could stand for one of several effects as well.
void add_alternatives(const Evidence& evidence, const Trials& trials, const Together& together,
                      std::size_t k, Selection& selection) {
  const Placed& chosen = together.chosen()[k];
  const Trial without = trials.with(all_but(together.chosen(), k), evidence.sets.all());
  const auto ranked = rank(trials, without, evidence.which_options(0.85, 0.95));
  if (ranked.empty() || ranked[0].fit.placed.on != chosen.on) return;
  auto same =
      confusable(ranked, trials.blocks(without, evidence.sets.held_out), evidence.which_options());
  same.push_back(0);
  for (const std::size_t n : same)
    if (const Named other = named(ranked[n], evidence.options.least_gain); !other.is(chosen))
      selection.confusable.push_back(other);
}

/// Several effects: each with its share of what they close together.
void settle(const Evidence& evidence, const Trials& trials, const Together& together,
            Selection& selection) {
  const Shares part = shares(evidence, trials, together.chosen());
  selection.interaction = part.interaction;
  selection.answer.clear();
  for (std::size_t k = 0; k < together.size(); ++k) {
    add_alternatives(evidence, trials, together, k, selection);
    Ranked r{together.fits()[k], {}, {}, part.share[k], part.interval[k], 0};
    selection.answer.push_back(named(r, 0));
    selection.answer.back().supported = part.lost[k].low > 0;
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
  s.gap = any_open(where(trials, trials.bare(), evidence.sets.all(), evidence.where_options()));
  if (!s.gap) return s;
  auto first = rank(trials, trials.bare(), evidence.which_options(0.1, 0.5));
  for (const Ranked& r : first) s.ranked.push_back(named(r, evidence.options.least_gain));
  sign(evidence, trials, stages, first, s.ranked);
  control_discoveries(first, s.ranked);
  if (first.empty() || !s.ranked[0].supported) return s;
  s.answer = {s.ranked[0]};
  Together together(evidence, trials, first[0].fit.placed);
  while (any_open(together.left(false)) && together.size() < evidence.options.most_effects)
    if (!together.add_another()) break;
  const bool alone = together.size() == 1;
  if (!alone) settle(evidence, trials, together, s);
  else
    for (const std::size_t k : confusable(
             first, trials.blocks(trials.bare(), evidence.sets.held_out), evidence.which_options()))
      s.confusable.push_back(s.ranked[k]);
  s.left = together.left(alone);
  s.trial = std::move(together.trial());
  return s;
}

}  // namespace sim::diagnosis

#include "sim/gap/estimation/completion.hpp"

#include <algorithm>
#include <optional>
#include <span>

#include "sim/gap/estimation/beyond.hpp"
#include "sim/gap/estimation/far_rivals.hpp"

namespace sim::estimation {

using effects::Placed;

bool is_never_certain(const Constant& c) { return c.zero || c.name == "inertia"; }

Uncertain uncertain_of(const erp::Robot& nominal, const std::vector<std::string>& withhold,
                       bool exact) {
  Uncertain u{nominal, constants_of(nominal)};
  std::erase_if(u.constants, [&](const Constant& c) {
    return (exact && !is_never_certain(c)) || std::ranges::count(withhold, c.effect) > 0;
  });
  return u;
}

bool are_same(const std::vector<Placed>& a, const std::vector<Placed>& b) {
  return std::ranges::is_permutation(
      a, b, {}, [](const Placed& p) { return std::pair(p.on, p.effect.index()); },
      [](const Placed& p) { return std::pair(p.on, p.effect.index()); });
}

void set_answer(AsBuilt& built, const JudgedEstimate& found) {
  built.indistinguishable.clear();
  for (std::size_t k = 0; k < found.train.point.effects.size(); ++k)
    built.indistinguishable.push_back(has_open_stage(found) ? std::vector<SizedEffect>{}
                                                            : indistinguishable(found, k));
  built.has_open_stage = has_open_stage(found);
  built.estimate = found.train;
}

JudgedEstimate complete(const Search& search, JudgedEstimate found, const Problem& problem,
                        AsBuilt& built) {
  built.estimate = found.train;
  complete_far_off(problem.train, built);
  JudgedEstimate settled = search.judge(built.estimate);
  settled.rivals = std::move(found.rivals);
  const double gain = std::max(0.0, found.cost - settled.cost);
  settled = with_rivals_far(search, std::move(settled), problem, gain, built);
  if (!built.beyond_tolerance.empty()) settled = search.pruned(std::move(settled));
  settled = search.without_doubtful(std::move(settled));
  set_answer(built, settled);
  built.cost = settled.cost;
  return settled;
}

namespace {

/// Adds `other` to the alternatives of `built` if one constant far off costs nearly the same as one
/// effect.
void add_alternatives(AsBuilt& built, const AsBuilt& other, double gain) {
  if (!are_indistinguishable(built.cost, other.cost, gain)) return;
  const auto far_constant = [](const AsBuilt& b) {
    const std::size_t k = b.beyond_tolerance[0];
    return as_effect(b.uncertain.constants[k], {k, b.estimate.point.x[k], b.estimate.sigma(k)});
  };
  const std::size_t effects = built.estimate.point.effects.size(),
                    other_effects = other.estimate.point.effects.size();
  if (built.beyond_tolerance.size() == 1 && other.beyond_tolerance.empty() &&
      other_effects == effects + 1)
    built.alternatives[0].push_back(sized_effects(other.estimate).back());
  if (built.beyond_tolerance.empty() && other.beyond_tolerance.size() == 1 &&
      effects == other_effects + 1)
    built.indistinguishable.back().push_back(far_constant(other));
}

bool is_among(const Placed& effect, std::span<const Placed> effects) {
  return std::ranges::any_of(effects, [&](const Placed& p) {
    return p.on == effect.on && p.effect.index() == effect.effect.index();
  });
}

/// Whether a constant of the robot represents the effect.
bool is_constant(const Placed& effect, const Uncertain& uncertain) {
  return std::ranges::any_of(uncertain.constants, [&](const Constant& c) {
    return c.effect == effects::about(effect.effect).type;
  });
}

/// If the cheapest answer has one effect, adds the other answers with one effect as its rivals.
/// `all`: the cheapest first.
void add_rivals(std::vector<JudgedEstimate>& all, double cost_without) {
  const auto is_one = [](const JudgedEstimate& f) { return f.train.point.effects.size() == 1; };
  if (!is_one(all[0])) return;
  Rivals& rivals = all[0].rivals.back();
  rivals.gain = cost_without - all[0].cost;
  for (const JudgedEstimate& other : all)
    if (is_one(other) && !are_same(other.train.point.effects, all[0].train.point.effects))
      rivals.all.push_back(sized_effects(other.train).back()), rivals.cost.push_back(other.cost);
}

/// Whether the answer leaves no stage open, and no parameter of its effects is at a bound.
bool is_valid(const AsBuilt& built) {
  return !built.has_open_stage && std::ranges::count(built.estimate.bound, true) == 0;
}

/// The cheapest answer with one more screened effect than `base` (if `screened`), or with a hint,
/// without or with the effects of `base`. Then more effects are added while a stage is open. The
/// two cheapest screened candidates are hints too, because a few steps do not reset constants that
/// have moved to imitate an effect.
std::optional<JudgedEstimate> with_effect(const Search& search, const JudgedEstimate& base,
                                          std::vector<Placed> hints, std::size_t max_effects,
                                          bool screened) {
  constexpr std::size_t screened_hints = 2;  // chosen
  const std::vector<Placed>& others = base.train.point.effects;
  const std::vector<JudgedEstimate> candidates =
      screened ? search.with_each_candidate(base) : std::vector<JudgedEstimate>{};
  std::vector<JudgedEstimate> all;
  if (others.size() < max_effects)
    if (auto found = search.best_of(candidates, base);
        found && (others.empty() || relieves(*found, base)))
      all.push_back(std::move(*found));
  for (const JudgedEstimate& one :
       std::span(candidates).first(std::min(screened_hints, candidates.size())))
    hints.push_back(one.train.point.effects.back());
  for (std::size_t n = 0; n < hints.size(); ++n) {
    const Placed& hint = hints[n];
    if (is_constant(hint, search.uncertain()) || is_among(hint, others) ||
        is_among(hint, std::span(hints).first(n)))
      continue;
    all.push_back(search.with({hint}));
    if (others.empty() || others.size() == max_effects) continue;
    std::vector<Placed> with_hint = others;
    with_hint.push_back(hint);
    all.push_back(search.with(with_hint));
  }
  if (all.empty()) return std::nullopt;
  std::ranges::stable_sort(all, {}, &JudgedEstimate::cost);
  add_rivals(all, base.cost);
  return search.run(std::move(all[0]), max_effects);
}

}  // namespace

AsBuilt answer_or_effect(const Problem& problem, AsBuilt built, const std::vector<Placed>& hints) {
  if (!built.has_open_stage && built.beyond_tolerance.empty() &&
      built.estimate.point.effects.empty())
    return built;
  AsBuilt other{.uncertain = built.uncertain};
  other.uncertain.far.assign(other.uncertain.constants.size(), false);
  const Search search(problem.train, problem.held_out, other.uncertain, problem.options.search);
  const JudgedEstimate base = search.from(built.estimate.point);
  const bool explains =
      !has_open_stage(base) && !base.train.point.effects.empty() && base.cost < built.cost;
  const auto found = explains
                         ? std::optional(base)
                         : with_effect(search, base, hints, problem.options.search.most_effects,
                                       has_open_stage(base) || !is_valid(built));
  if (!found) return built;
  complete(search, *found, problem, other);
  const double gain = base.cost - std::min(built.cost, other.cost);
  add_alternatives(built, other, gain), add_alternatives(other, built, gain);
  const auto causes = [](const AsBuilt& b) {
    return b.beyond_tolerance.size() + b.estimate.point.effects.size();
  };
  if (!built.has_open_stage && causes(other) > causes(built)) return built;
  const bool is_equivalent_constant = built.beyond_tolerance.size() == 1 &&
                                      built.estimate.point.effects.empty() &&
                                      are_indistinguishable(built.cost, other.cost, gain);
  return other.cost < built.cost && !other.has_open_stage && !is_equivalent_constant ? other
                                                                                     : built;
}

}  // namespace sim::estimation

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

void take(AsBuilt& built, const Found& found) {
  built.indistinguishable.clear();
  for (std::size_t k = 0; k < found.train.point.effects.size(); ++k)
    built.indistinguishable.push_back(keeps(found) ? std::vector<Sized>{}
                                                   : indistinguishable(found, k));
  built.keeps = keeps(found);
  built.estimate = found.train;
}

Found complete(const Search& search, Found found, const Problem& problem, AsBuilt& built) {
  built.estimate = found.train;
  complete_far_off(problem.train, built);
  Found settled = search.judge(built.estimate);
  settled.rivals = std::move(found.rivals);
  const double gain = std::max(0.0, found.cost - settled.cost);
  settled = with_rivals_far(search, std::move(settled), problem, gain, built);
  if (!built.beyond.empty()) settled = search.pruned(std::move(settled));
  settled = search.without_doubtful(std::move(settled));
  take(built, settled);
  built.cost = settled.cost;
  return settled;
}

namespace {

/// Adds the other answer as an alternative if one constant far off costs nearly the same as one effect.
void add_alternatives(AsBuilt& is, const AsBuilt& other, double gain) {
  if (!are_indistinguishable(is.cost, other.cost, gain)) return;
  const auto far_of = [](const AsBuilt& b) {
    const std::size_t k = b.beyond[0];
    return as_effect(b.uncertain.constants[k], {k, b.estimate.point.x[k], b.estimate.sigma(k)});
  };
  const std::size_t effects = is.estimate.point.effects.size(),
                    of_other = other.estimate.point.effects.size();
  if (is.beyond.size() == 1 && other.beyond.empty() && of_other == effects + 1)
    is.instead[0].push_back(sized(other.estimate).back());
  if (is.beyond.empty() && other.beyond.size() == 1 && effects == of_other + 1)
    is.indistinguishable.back().push_back(far_of(other));
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

/// Adds the other answers to the first, cheapest one as rivals, as far as each has one effect.
void add_rivals(std::vector<Found>& all, double cost_without) {
  const auto is_one = [](const Found& f) { return f.train.point.effects.size() == 1; };
  if (!is_one(all[0])) return;
  Rivals& rivals = all[0].rivals.back();
  rivals.gain = cost_without - all[0].cost;
  for (const Found& other : all)
    if (is_one(other) && !are_same(other.train.point.effects, all[0].train.point.effects))
      rivals.all.push_back(sized(other.train).back()), rivals.cost.push_back(other.cost);
}

/// Whether the answer leaves no more than noise, and no parameter of its effects is at a bound.
bool is_valid(const AsBuilt& built) {
  return !built.keeps && std::ranges::count(built.estimate.bound, true) == 0;
}

/// The cheapest answer with one more screened effect than `base` (if `screened`), or with a hint, alone or in addition.
/// Then more effects are added while a stage keeps more than noise. The two cheapest screened candidates are hints too:
/// after constants have moved to imitate an effect, a few steps do not lead back.
std::optional<Found> with_effect(const Search& search, const Found& base, std::vector<Placed> hints,
                                 std::size_t most, bool screened) {
  constexpr std::size_t near = 2;  // screened candidates used as hints; chosen
  const std::vector<Placed>& others = base.train.point.effects;
  const std::vector<Found> joined =
      screened ? search.with_each_candidate(base) : std::vector<Found>{};
  std::vector<Found> all;
  if (others.size() < most)
    if (auto found = search.best_of(joined, base);
        found && (others.empty() || relieves(*found, base)))
      all.push_back(std::move(*found));
  for (const Found& one : std::span(joined).first(std::min(near, joined.size())))
    hints.push_back(one.train.point.effects.back());
  for (std::size_t n = 0; n < hints.size(); ++n) {
    const Placed& hint = hints[n];
    if (is_constant(hint, search.uncertain()) || is_among(hint, others) ||
        is_among(hint, std::span(hints).first(n)))
      continue;
    all.push_back(search.with({hint}));
    if (others.empty() || others.size() == most) continue;
    std::vector<Placed> more = others;
    more.push_back(hint);
    all.push_back(search.with(more));
  }
  if (all.empty()) return std::nullopt;
  std::ranges::stable_sort(all, {}, &Found::cost);
  add_rivals(all, base.cost);
  return search.run(std::move(all[0]), most);
}

}  // namespace

AsBuilt or_effect(const Problem& problem, AsBuilt built, const std::vector<Placed>& hints) {
  if (!built.keeps && built.beyond.empty() && built.estimate.point.effects.empty()) return built;
  AsBuilt other{.uncertain = built.uncertain};
  other.uncertain.far.assign(other.uncertain.constants.size(), false);
  const Search search(problem.train, problem.held_out, other.uncertain, problem.options.search);
  const Found base = search.from(built.estimate.point);
  const bool explains = !keeps(base) && !base.train.point.effects.empty() && base.cost < built.cost;
  const auto found = explains
                         ? std::optional(base)
                         : with_effect(search, base, hints, problem.options.search.most_effects,
                                       keeps(base) || !is_valid(built));
  if (!found) return built;
  complete(search, *found, problem, other);
  const double gain = base.cost - std::min(built.cost, other.cost);
  add_alternatives(built, other, gain), add_alternatives(other, built, gain);
  const auto causes = [](const AsBuilt& b) {
    return b.beyond.size() + b.estimate.point.effects.size();
  };
  if (!built.keeps && causes(other) > causes(built)) return built;
  const bool is_twin = built.beyond.size() == 1 && built.estimate.point.effects.empty() &&
                       are_indistinguishable(built.cost, other.cost, gain);
  return other.cost < built.cost && !other.keeps && !is_twin ? other : built;
}

}  // namespace sim::estimation

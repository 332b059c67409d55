#include "sim/gap/as_built.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "sim/gap/beyond.hpp"

namespace sim::gap {
namespace {

using effects::Placed;

/// What nobody measures when a robot is drawn: where things are zero, and how a body's mass is spread.
bool is_never_certain(const Constant& c) { return c.zero || c.name == "inertia"; }

/// All of its constants, or those alone that are never certain.
Uncertain uncertain_of(const erp::Robot& nominal, const std::vector<std::string>& withhold,
                       bool exact) {
  Uncertain u{nominal, constants_of(nominal)};
  std::erase_if(u.constants, [&](const Constant& c) {
    return (exact && !is_never_certain(c)) || std::ranges::count(withhold, c.effect) > 0;
  });
  return u;
}

/// More than three stages and a fifth of them keep more than noise: no few effects do that; chosen.
bool is_widespread(const Found& found) {
  const std::size_t open = stages_kept(found);
  return open > 3 && 5 * open > found.tolerated.size();
}

bool are_same(const std::vector<Placed>& a, const std::vector<Placed>& b) {
  return std::ranges::is_permutation(
      a, b, {}, [](const Placed& p) { return std::pair(p.on, p.effect.index()); },
      [](const Placed& p) { return std::pair(p.on, p.effect.index()); });
}

struct Evidence {
  const erp::Robot& nominal;
  const Estimator& train;
  const ResidualVector& held_out;
  const AsBuiltOptions& options;
};

void take(AsBuilt& built, const Found& found) {
  built.indistinguishable.clear();
  for (std::size_t k = 0; k < found.train.point.effects.size(); ++k)
    built.indistinguishable.push_back(keeps(found) ? std::vector<Sized>{}
                                                   : indistinguishable(found, k));
  built.keeps = keeps(found);
  built.estimate = found.train;
}

/// Completes an answer with its constants that are far off, less the effects that those make needless. `search` must
/// refer to `built.uncertain`.
Found settle(const Search& search, Found found, const Evidence& evidence, AsBuilt& built) {
  built.estimate = found.train;
  settle_far_off(evidence.train, built);
  Found settled = search.judge(built.estimate);
  settled.rivals = std::move(found.rivals);
  if (!built.beyond.empty()) settled = search.pruned(std::move(settled));
  take(built, settled);
  built.cost = settled.cost;
  return settled;
}

/// Adds the other answer as an alternative, where one constant far off costs nearly the same as one effect.
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

/// Whether a constant of the robot stands for that effect.
bool is_constant(const Placed& effect, const Uncertain& uncertain) {
  return std::ranges::any_of(uncertain.constants, [&](const Constant& c) {
    return c.effect == effects::about(effect.effect).type;
  });
}

/// Adds to the first of answers, the cheapest, the others if each is one effect.
void add_rivals(std::vector<Found>& all, double cost_without) {
  const auto is_one = [](const Found& f) { return f.train.point.effects.size() == 1; };
  if (!is_one(all[0])) return;
  Rivals& rivals = all[0].rivals.back();
  rivals.gain = cost_without - all[0].cost;
  for (const Found& other : all)
    if (is_one(other) && !are_same(other.train.point.effects, all[0].train.point.effects))
      rivals.all.push_back(sized(other.train).back()), rivals.cost.push_back(other.cost);
}

/// It explains, and no parameter of its effects ends at a bound.
bool stands(const AsBuilt& built) {
  return !built.keeps && std::ranges::count(built.estimate.bound, true) == 0;
}

/// The cheapest with one more effect than `base`, if `screened`, or with a hint, alone or as one
/// more; then with others while a stage keeps more than noise. Hints are as well those nearest to cost less than
/// `base`: with constants that have gone along to imitate one, few steps do not lead back.
std::optional<Found> with_effect(const Search& search, const Found& base, std::vector<Placed> hints,
                                 std::size_t most, bool screened) {
  constexpr std::size_t near = 2;  // of those that were screened; chosen
  const std::vector<Placed>& others = base.train.point.effects;
  const std::vector<Found> joined = screened ? search.each_beside(base) : std::vector<Found>{};
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

/// The answer itself, or one with effects and no constant far off if that costs less and they are no
/// more causes; of twins the one constant.
/// `hints`: effects that would explain most were all constants as described. Beside constants that have
/// gone along to imitate it, an effect is no longer found.
AsBuilt or_effect(const Evidence& evidence, AsBuilt built, const std::vector<Placed>& hints) {
  if (!built.keeps && built.beyond.empty() && built.estimate.point.effects.empty()) return built;
  AsBuilt other{.uncertain = built.uncertain};
  other.uncertain.far.assign(other.uncertain.constants.size(), false);
  const Search search(evidence.train, evidence.held_out, other.uncertain, evidence.options.search);
  const Found base = search.from(built.estimate.point);
  const bool explains = !keeps(base) && !base.train.point.effects.empty() && base.cost < built.cost;
  const auto found = explains
                         ? std::optional(base)
                         : with_effect(search, base, hints, evidence.options.search.most_effects,
                                       keeps(base) || !stands(built));
  if (!found) return built;
  settle(search, *found, evidence, other);
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

/// −2 log of its evidence, by Laplace's approximation: constants that recordings determine had room before.
double evidence_cost(const AsBuilt& built) {
  const Eigen::Index n = Eigen::Index(built.uncertain.constants.size());
  const Eigen::MatrixXd of_constants = built.estimate.covariance.topLeftCorner(n, n);
  return built.cost - of_constants.ldlt().vectorD().array().log().sum();
}

/// The effect that was added last, and those that came near it.
std::vector<Placed> hints_of(const Found& found) {
  std::vector<Placed> hints{found.train.point.effects.back()};
  for (const Sized& rival : found.rivals.back().all) hints.push_back(rival.effect);
  return hints;
}

/// All as described but for effects, and for what is never certain. Sets `hints` for `or_effect`.
AsBuilt explained_exactly(const Evidence& evidence, std::vector<Placed>& hints) {
  const AsBuiltOptions& options = evidence.options;
  AsBuilt built{.uncertain = uncertain_of(evidence.nominal, options.search.withhold, true),
                .exact = true};
  const Search search(evidence.train, evidence.held_out, built.uncertain, options.search);
  Found found = search.with({});
  if (auto first = keeps(found) ? search.best_beside(found) : std::nullopt) {
    hints = hints_of(*first);
    if (relieves(*first, found)) found = std::move(*first);
  }
  if (!is_widespread(found)) found = search.run(std::move(found), options.search.most_effects);
  const auto& suggested = options.suggested;
  if (!suggested.empty() && !are_same(found.train.point.effects, suggested))
    if (Found other = search.with(suggested); other.cost < found.cost) found = std::move(other);
  take(built, found);
  built.cost = found.cost;
  list_uncertain(built);
  return built;
}

/// With all constants uncertain.
AsBuilt explained(const Evidence& evidence, const std::vector<Placed>& hints) {
  AsBuilt built{.uncertain =
                    uncertain_of(evidence.nominal, evidence.options.search.withhold, false)};
  const Search search(evidence.train, evidence.held_out, built.uncertain, evidence.options.search);
  Found found = settle(search, search.with({}), evidence, built);
  if (built.keeps)
    settle(search, search.run(std::move(found), evidence.options.search.most_effects), evidence,
           built);
  return or_effect(evidence, std::move(built), hints);
}

}  // namespace

double determined(const AsBuilt& built, std::size_t constant) {
  return std::max(0.0, 1 - std::pow(built.estimate.sigma(constant), 2));
}

AsBuilt calibrated(const erp::Robot& nominal, std::span<const residuals::Episode> train,
                   const EstimateOptions& options) {
  const Estimator estimator(nominal, train, options);
  AsBuilt built{.uncertain = uncertain_of(nominal, {}, false)};
  built.estimate = estimator.run(built.uncertain, {});
  settle_far_off(estimator, built);
  built.robot = robot_at(built.uncertain, built.estimate.point);
  return built;
}

AsBuilt as_built(const erp::Robot& nominal, std::span<const residuals::Episode> train,
                 std::span<const residuals::Episode> held_out, const AsBuiltOptions& options) {
  const Estimator estimator(nominal, train, options.estimate);
  const ResidualVector judged(nominal, held_out, options.estimate.seed, options.estimate.threads);
  const Evidence evidence{nominal, estimator, judged, options};
  std::vector<Placed> hints;
  AsBuilt built = explained_exactly(evidence, hints);
  if (built.keeps)
    if (AsBuilt other = explained(evidence, hints); evidence_cost(other) < evidence_cost(built))
      built = std::move(other);
  built.robot = robot_at(built.uncertain, built.estimate.point);
  return built;
}

}  // namespace sim::gap

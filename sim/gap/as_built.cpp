#include "sim/gap/as_built.hpp"

#include <algorithm>
#include <cmath>

namespace sim::gap {
namespace {

constexpr double beyond = 2.5, beyond_zero = 5;  // tolerances; chosen
/// A zero where all else is exact: tolerances, and of its own deviation; chosen.
constexpr double exact_zero = 1, clear = 5;

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

void list_beyond(AsBuilt& built) {
  const auto far = [&](std::size_t k) { return std::abs(built.estimate.point.x[k]); };
  const auto least = [&](std::size_t k) {
    if (!built.uncertain.constants[k].zero) return beyond;
    return built.exact ? std::max(exact_zero, clear * built.estimate.sigma(k)) : beyond_zero;
  };
  for (std::size_t k = 0; k < built.uncertain.constants.size(); ++k)
    if (far(k) > least(k) && determined(built, k) > well_determined) built.beyond.push_back(k);
  std::ranges::sort(built.beyond, std::greater(), far);
}

/// More than three stages and a fifth of them keep more than noise: no few effects do that; chosen.
bool is_widespread(const Found& found) {
  const std::size_t open = stages_kept(found);
  return open > 3 && 5 * open > found.tolerated.size();
}

bool are_same(const std::vector<effects::Placed>& a, const std::vector<effects::Placed>& b) {
  return std::ranges::is_permutation(
      a, b, {}, [](const effects::Placed& p) { return std::pair(p.on, p.effect.index()); },
      [](const effects::Placed& p) { return std::pair(p.on, p.effect.index()); });
}

struct Evidence {
  const erp::Robot& nominal;
  const Estimator& train;
  const ResidualVector& held_out;
  const AsBuiltOptions& options;
};

/// Constants that are more than so many tolerances off, the nearest first.
std::vector<std::size_t> strained(const Uncertain& uncertain, const Found& found, double far) {
  const std::vector<double>& x = found.train.point.x;
  std::vector<std::size_t> all;
  for (std::size_t k = 0; k < x.size(); ++k)
    if (!uncertain.constants[k].zero && std::abs(x[k]) > far) all.push_back(k);
  std::ranges::sort(all, {}, [&](std::size_t k) { return std::abs(x[k]); });
  return all;
}

/// Where recordings determine only what two constants make together, the prior prefers one far off to
/// two: each is let go in turn, for steps from between the two gain little.
Found settled(const Uncertain& uncertain, const Search& search, Found found) {
  constexpr std::size_t most = 4;  // chosen
  constexpr double usual = 2;      // tolerances; chosen
  auto far = strained(uncertain, found, usual);
  if (far.size() < 2) return found;
  far.resize(std::min(most, far.size()));
  for (const std::size_t k : far) {
    Point start = found.train.point;
    start.x[k] = 0;
    if (Found other = search.from(std::move(start)); other.cost < found.cost) {
      other.rivals = found.rivals;
      found = std::move(other);
    }
  }
  return found;
}

/// A strained constant may stand for an effect, which is looked for with that part as described: others of
/// its constants would take the strain over.
Found unstrained(const Evidence& evidence, const Uncertain& uncertain, const Search& search,
                 Found found) {
  constexpr double never = 4;             // tolerances: building explains no more; chosen
  constexpr double worth_an_effect = 20;  // of the cost; chosen
  const auto far = strained(uncertain, found, never);
  const std::size_t most = evidence.options.search.most_effects;
  if (far.empty() || !found.train.point.effects.empty()) return found;
  Uncertain others = uncertain;
  others.constants.clear();
  for (std::size_t k = 0; k < uncertain.constants.size(); ++k)
    if (std::ranges::none_of(far, [&](std::size_t f) {
          return uncertain.constants[f].on == uncertain.constants[k].on;
        }))
      others.constants.push_back(uncertain.constants[k]);
  const Search again(evidence.train, evidence.held_out, others, evidence.options.search);
  const Found with_effects = again.run(again.with({}), most);
  if (with_effects.train.point.effects.empty()) return found;
  Found other = search.with(with_effects.train.point.effects);
  other.rivals = with_effects.rivals;
  const double needed = worth_an_effect * double(other.train.point.effects.size());
  return other.cost + needed < found.cost ? other : found;
}

AsBuilt explained(const Evidence& evidence, bool exact) {
  AsBuilt built{
      .uncertain = uncertain_of(evidence.nominal, evidence.options.search.withhold, exact),
      .exact = exact};
  const Search search(evidence.train, evidence.held_out, built.uncertain, evidence.options.search);
  std::size_t most = evidence.options.search.most_effects;
  Found found = search.run(search.with({}), exact ? 1 : most);
  if (exact && !is_widespread(found)) found = search.run(std::move(found), most);
  if (!exact) {
    found = unstrained(evidence, built.uncertain, search, std::move(found));
    found = settled(built.uncertain, search, std::move(found));
  }
  const auto& suggested = evidence.options.suggested;
  if (exact && !suggested.empty() && !are_same(found.train.point.effects, suggested))
    if (Found other = search.with(suggested); other.cost < found.cost) found = std::move(other);
  for (std::size_t k = 0; k < found.train.point.effects.size(); ++k)
    built.indistinguishable.push_back(keeps(found) ? std::vector<Sized>{}
                                                   : indistinguishable(found, k));
  built.cost = found.cost, built.keeps = keeps(found);
  built.estimate = std::move(found.train);
  list_beyond(built);
  built.robot = robot_at(built.uncertain, built.estimate.point);
  return built;
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
  list_beyond(built);
  built.robot = robot_at(built.uncertain, built.estimate.point);
  return built;
}

AsBuilt as_built(const erp::Robot& nominal, std::span<const residuals::Episode> train,
                 std::span<const residuals::Episode> held_out, const AsBuiltOptions& options) {
  const Estimator estimator(nominal, train, options.estimate);
  const ResidualVector judged(nominal, held_out, options.estimate.seed, options.estimate.threads);
  const Evidence evidence{nominal, estimator, judged, options};
  AsBuilt exact = explained(evidence, true);
  if (!exact.keeps) return exact;
  AsBuilt built = explained(evidence, false);
  return exact.cost < built.cost ? exact : built;
}

}  // namespace sim::gap

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

AsBuilt explained(const Evidence& evidence, bool exact) {
  AsBuilt built{
      .uncertain = uncertain_of(evidence.nominal, evidence.options.search.withhold, exact),
      .exact = exact};
  const Search search(evidence.train, evidence.held_out, built.uncertain, evidence.options.search);
  std::size_t most = evidence.options.search.most_effects;
  Found found = search.run(search.with({}), exact ? 1 : most);
  if (exact && !is_widespread(found)) found = search.run(std::move(found), most);
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

#include "sim/gap/estimation/search.hpp"

#include <algorithm>
#include <cmath>

#include "interfaces/parallel/in_parallel.hpp"

namespace sim::estimation {
namespace {

constexpr double smallest_removed_fraction = 0.3;  // of a stage's excess, by an effect; chosen
/// −2 log of the odds that a robot has an effect; chosen: like the price of a constant far off
/// (unknowns.hpp).
constexpr double effect_price = 9;

/// The excess above which a stage is open. It grows with the nominal excess because laws are
/// approximations; chosen.
double tolerated(double nominal_excess) { return std::clamp(0.002 * nominal_excess, 0.6, 2.0); }

bool is_same(const effects::Placed& a, const effects::Placed& b) {
  return a.on == b.on && a.effect.index() == b.effect.index();
}

/// Whether two effects are at one place. Several effects at one place can approximate nearly any
/// law.
bool are_at_one_place(const effects::Placed& a, const effects::Placed& b) {
  return a.on == b.on && effects::about(a.effect).stage == effects::about(b.effect).stage;
}

/// Rivals of an effect after a second search for it, which resulted in `other`.
Rivals rivals_of(const JudgedEstimate& found, std::size_t effect, const JudgedEstimate& other,
                 double cost_without) {
  Rivals rivals{.gain = cost_without - found.cost};
  const auto add = [&](const SizedEffect& one, double cost) {
    if (is_same(one.effect, found.train.point.effects[effect])) return;
    rivals.all.push_back(one), rivals.cost.push_back(cost);
  };
  add(sized_effects(other.train).back(), other.cost);
  const Rivals& other_rivals = other.rivals.back();
  for (std::size_t k = 0; k < other_rivals.all.size(); ++k)
    add(other_rivals.all[k], other_rivals.cost[k]);
  return rivals;
}

}  // namespace

bool relieves(const JudgedEstimate& after, const JudgedEstimate& before) {
  for (std::size_t s = 0; s < before.held_out.excess.size(); ++s) {
    const double excess = before.held_out.excess[s];
    if (excess > before.tolerated[s] &&
        excess - after.held_out.excess[s] > smallest_removed_fraction * excess)
      return true;
  }
  return false;
}

std::vector<bool> open_stages(const JudgedEstimate& found) {
  std::vector<bool> open;
  for (std::size_t s = 0; s < found.tolerated.size(); ++s)
    open.push_back(std::max(found.on_train.excess[s], found.held_out.excess[s]) >
                   found.tolerated[s]);
  return open;
}

Search::Search(const Estimator& train, const ResidualVector& held_out, const Uncertain& uncertain,
               const SearchOptions& options)
    : train_(train),
      held_out_(held_out),
      uncertain_(uncertain),
      options_(options),
      screen_(train_, uncertain_, options_.withhold) {
  const ResidualVector& residuals = train_.residuals();
  const Explained nominal = residuals.explain(uncertain_.nominal, train_.options().threads);
  for (const double e : remaining_residual(residuals, nominal, residuals.z(nominal)).excess)
    tolerated_.push_back(tolerated(e));
}

JudgedEstimate Search::judge(Estimate estimate) const {
  JudgedEstimate found{.train = std::move(estimate), .tolerated = tolerated_};
  found.on_train = remaining_residual(train_.residuals(), found.train.explained, found.train.z);
  const Explained held_out = held_out_.explain(robot_at(uncertain_, found.train.point), 1);
  found.held_out = remaining_residual(held_out_, held_out, held_out_.z(held_out));
  found.cost = misfit(found.on_train, train_.residuals()) + misfit(found.held_out, held_out_) +
               prior_cost(uncertain_, found.train.point) +
               effect_price * double(found.train.point.effects.size());
  return found;
}

JudgedEstimate Search::from(Point start) const {
  const std::size_t effects = start.effects.size();
  JudgedEstimate found = judge(train_.run(uncertain_, std::move(start)));
  found.rivals.resize(effects);
  return found;
}

std::vector<JudgedEstimate> Search::with_each_candidate(const JudgedEstimate& base) const {
  constexpr int iterations = 4;  // chosen
  auto candidates = screen_.candidates(base.train, open_stages(base));
  const bool is_drive = !uncertain_.nominal.drives.empty();  // its whole friction is at one place
  std::erase_if(candidates, [&](const auto& c) {
    return !is_drive && std::ranges::any_of(base.train.point.effects, [&](const auto& e) {
      return are_at_one_place(e, c.start);
    });
  });
  if (candidates.size() > options_.estimated) candidates.resize(options_.estimated);
  const Unknowns at(uncertain_, base.train.point);
  std::vector<JudgedEstimate> joined(candidates.size());
  in_parallel(candidates.size(), train_.options().threads, [&](std::size_t k) {
    Point start = at.moved(candidates[k].others).point();
    start.effects.push_back(candidates[k].start);
    joined[k] = judge(train_.candidate(uncertain_, base.train, std::move(start), iterations));
  });
  std::ranges::stable_sort(joined, {}, &JudgedEstimate::cost);
  return joined;
}

/// The cheapest of `joined` after estimation until convergence, with its rivals.
JudgedEstimate Search::with_best_of(const std::vector<JudgedEstimate>& joined,
                                    const JudgedEstimate& base) const {
  // Of the minimum by a few steps, relative to the gain; chosen.
  constexpr double possible_miss = 0.3;
  constexpr std::size_t max_estimated = 4;  // chosen
  std::vector<JudgedEstimate> converged;
  const double cost_limit = joined[0].cost + possible_miss * (base.cost - joined[0].cost);
  for (const JudgedEstimate& one : joined)
    if (converged.empty() || (converged.size() < max_estimated && one.cost < cost_limit))
      converged.push_back(judge(train_.continued(uncertain_, one.train)));
  std::ranges::stable_sort(converged, {}, &JudgedEstimate::cost);
  Rivals rivals{.gain = base.cost - converged[0].cost};
  for (std::size_t k = 1; k < converged.size(); ++k) {
    rivals.all.push_back(sized_effects(converged[k].train).back());
    rivals.cost.push_back(converged[k].cost);
  }
  converged[0].rivals = base.rivals;
  converged[0].rivals.push_back(std::move(rivals));
  return std::move(converged[0]);
}

std::optional<JudgedEstimate> Search::best_of(const std::vector<JudgedEstimate>& joined,
                                              const JudgedEstimate& base) const {
  if (joined.empty() || !(joined[0].cost < base.cost)) return std::nullopt;
  return with_best_of(joined, base);
}

JudgedEstimate Search::without(const JudgedEstimate& found, std::size_t effect) const {
  Point others = found.train.point;
  others.effects.erase(others.effects.begin() + std::ptrdiff_t(effect));
  JudgedEstimate remaining = judge(train_.run(uncertain_, others));
  remaining.rivals = found.rivals;
  remaining.rivals.erase(remaining.rivals.begin() + std::ptrdiff_t(effect));
  return remaining;
}

JudgedEstimate Search::pruned(JudgedEstimate found) const {
  for (std::size_t k = 0; k < found.train.point.effects.size(); ++k)
    if (JudgedEstimate base = without(found, k); base.cost < found.cost)
      return pruned(std::move(base));
  return found;
}

namespace {

/// Whether the estimate of an effect is compatible with a robot without it: the intervals of all
/// its fitted parameters contain their neutral values.
bool may_be_neutral(const SizedEffect& estimated) {
  constexpr double half_interval_sigmas = 1.96;  // of 95 %
  effects::AnyEffect effect = estimated.effect.effect;
  effects::AnyEffect neutral = *effects::neutral(effects::about(effect).type);
  const auto values = effects::parameters(effect), neutrals = effects::parameters(neutral);
  for (std::size_t p = 0, k = 0; p < values.size(); ++p) {
    if (!is_estimated(values[p])) continue;
    const double sigma = estimated.sigma[k++];
    if (values[p].fitted &&
        std::abs(*values[p].value - *neutrals[p].value) > half_interval_sigmas * sigma)
      return false;
  }
  return true;
}

/// For each effect, whether one of its parameters is at a bound, or it may be neutral.
std::vector<bool> doubtful(const Estimate& estimate) {
  std::vector<bool> flags;
  std::size_t k = estimate.point.x.size();
  for (const SizedEffect& one : sized_effects(estimate)) {
    bool is_doubtful = may_be_neutral(one);
    for (std::size_t p = 0; p < one.sigma.size(); ++p) is_doubtful |= estimate.bound[k++];
    flags.push_back(is_doubtful);
  }
  return flags;
}

}  // namespace

JudgedEstimate Search::without_doubtful(JudgedEstimate found) const {
  const std::vector<bool> is_doubtful = doubtful(found.train);
  for (std::size_t k = 0; k < is_doubtful.size(); ++k)
    if (is_doubtful[k])
      if (JudgedEstimate base = without(found, k); !has_open_stage(base))
        return without_doubtful(std::move(base));
  return found;
}

/// Removes or replaces effects that were added before the last one. Such an effect may have been a
/// compromise between two effects, or may have become unnecessary.
JudgedEstimate Search::exchanged(JudgedEstimate found) const {
  constexpr double improvement = 0.98;  // largest cost / previous cost; chosen
  for (std::size_t k = 0; k + 1 < found.train.point.effects.size(); ++k) {
    const JudgedEstimate base = without(found, k);
    if (base.cost < found.cost) return exchanged(base);
    const auto joined = with_each_candidate(base);
    if (joined.empty()) continue;
    JudgedEstimate other = with_best_of(joined, base);
    if (other.cost < improvement * found.cost)  // another effect, or another minimum of the same
      found = pruned(std::move(other));
    else found.rivals[k] = rivals_of(found, k, other, base.cost);
  }
  return found;
}

JudgedEstimate Search::run(JudgedEstimate found, std::size_t max_effects) const {
  const std::size_t rounds = 2 * max_effects;  // a removed effect may be added again
  for (std::size_t round = 0;
       round < rounds && has_open_stage(found) && found.train.point.effects.size() < max_effects;
       ++round) {
    if (options_.progress)
      options_.progress("effects", double(found.train.point.effects.size()) / double(max_effects));
    auto extended = with_best_candidate(found);
    if (!extended || !relieves(*extended, found)) break;
    found = exchanged(std::move(*extended));
  }
  return without_doubtful(std::move(found));
}

std::vector<SizedEffect> sized_effects(const Estimate& estimate) {
  std::vector<SizedEffect> all;
  std::size_t k = estimate.point.x.size();
  for (effects::Placed effect : estimate.point.effects) {
    std::vector<double> sigma;
    for (const effects::Parameter& p : effects::parameters(effect.effect))
      if (is_estimated(p)) sigma.push_back(estimate.sigma(k++));
    all.push_back({std::move(effect), std::move(sigma)});
  }
  return all;
}

bool are_indistinguishable(double cost, double other, double gain) {
  constexpr double margin = 4, relative_margin = 0.02;  // chosen
  return std::abs(other - cost) < margin + relative_margin * gain;
}

std::vector<SizedEffect> indistinguishable(const JudgedEstimate& found, std::size_t effect) {
  const Rivals& rivals = found.rivals[effect];
  std::vector<SizedEffect> all;
  for (std::size_t k = 0; k < rivals.all.size(); ++k)
    if (rivals.cost[k] < found.cost ||
        are_indistinguishable(found.cost, rivals.cost[k], rivals.gain))
      all.push_back(rivals.all[k]);
  return all;
}

}  // namespace sim::estimation

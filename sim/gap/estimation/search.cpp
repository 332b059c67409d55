#include "sim/gap/estimation/search.hpp"

#include <algorithm>
#include <cmath>

#include "interfaces/parallel/in_parallel.hpp"

namespace sim::estimation {
namespace {

constexpr double worth = 0.3;  // share of a stage's excess that an effect must remove; chosen
/// −2 log of the odds that a robot has one effect; chosen, as that of a constant far off (unknowns.hpp).
constexpr double effect_price = 9;

/// The excess of a stage that needs no effect. It grows with the nominal excess, for laws are approximations; chosen.
double tolerated(double nominal_excess) { return std::clamp(0.002 * nominal_excess, 0.6, 2.0); }

bool is_same(const effects::Placed& a, const effects::Placed& b) {
  return a.on == b.on && a.effect.index() == b.effect.index();
}

/// Several causes at one place can approximate nearly any law.
bool are_at_one_place(const effects::Placed& a, const effects::Placed& b) {
  return a.on == b.on && effects::about(a.effect).stage == effects::about(b.effect).stage;
}

/// Rivals of an effect after a second search for it, which resulted in `other`.
Rivals rivals_of(const Found& found, std::size_t effect, const Found& other, double cost_without) {
  Rivals rivals{.gain = cost_without - found.cost};
  const auto add = [&](const Sized& one, double cost) {
    if (is_same(one.effect, found.train.point.effects[effect])) return;
    rivals.all.push_back(one), rivals.cost.push_back(cost);
  };
  add(sized(other.train).back(), other.cost);
  const Rivals& of_other = other.rivals.back();
  for (std::size_t k = 0; k < of_other.all.size(); ++k) add(of_other.all[k], of_other.cost[k]);
  return rivals;
}

}  // namespace

bool relieves(const Found& after, const Found& before) {
  for (std::size_t s = 0; s < before.held_out.excess.size(); ++s) {
    const double excess = before.held_out.excess[s];
    if (excess > before.tolerated[s] && excess - after.held_out.excess[s] > worth * excess)
      return true;
  }
  return false;
}

std::vector<bool> open_stages(const Found& found) {
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

Found Search::judge(Estimate estimate) const {
  Found found{.train = std::move(estimate), .tolerated = tolerated_};
  found.on_train = remaining_residual(train_.residuals(), found.train.explained, found.train.z);
  const Explained held_out = held_out_.explain(robot_at(uncertain_, found.train.point), 1);
  found.held_out = remaining_residual(held_out_, held_out, held_out_.z(held_out));
  found.cost = misfit(found.on_train, train_.residuals()) + misfit(found.held_out, held_out_) +
               prior_cost(uncertain_, found.train.point) +
               effect_price * double(found.train.point.effects.size());
  return found;
}

Found Search::from(Point start) const {
  const std::size_t effects = start.effects.size();
  Found found = judge(train_.run(uncertain_, std::move(start)));
  found.rivals.resize(effects);
  return found;
}

std::vector<Found> Search::with_each_candidate(const Found& base) const {
  constexpr int iterations = 4;
  auto candidates = screen_.candidates(base.train, open_stages(base));
  const bool drive = !uncertain_.nominal.drives.empty();  // all its friction is at one place
  std::erase_if(candidates, [&](const auto& c) {
    return !drive && std::ranges::any_of(base.train.point.effects, [&](const auto& e) {
      return are_at_one_place(e, c.start);
    });
  });
  if (candidates.size() > options_.estimated) candidates.resize(options_.estimated);
  const Unknowns at(uncertain_, base.train.point);
  std::vector<Found> joined(candidates.size());
  in_parallel(candidates.size(), train_.options().threads, [&](std::size_t k) {
    Point start = at.moved(candidates[k].others).point();
    start.effects.push_back(candidates[k].start);
    joined[k] = judge(train_.candidate(uncertain_, base.train, std::move(start), iterations));
  });
  std::ranges::stable_sort(joined, {}, &Found::cost);
  return joined;
}

/// The cheapest of `joined` after estimation until convergence, with its rivals.
Found Search::with_best_of(const std::vector<Found>& joined, const Found& base) const {
  constexpr double unsettled =
      0.3;  // share of the gain by which few steps may miss the minimum; chosen
  constexpr std::size_t most = 4;  // chosen
  std::vector<Found> ended;
  const double near = joined[0].cost + unsettled * (base.cost - joined[0].cost);
  for (const Found& one : joined)
    if (ended.empty() || (ended.size() < most && one.cost < near))
      ended.push_back(judge(train_.continued(uncertain_, one.train)));
  std::ranges::stable_sort(ended, {}, &Found::cost);
  Rivals rivals{.gain = base.cost - ended[0].cost};
  for (std::size_t k = 1; k < ended.size(); ++k) {
    rivals.all.push_back(sized(ended[k].train).back());
    rivals.cost.push_back(ended[k].cost);
  }
  ended[0].rivals = base.rivals;
  ended[0].rivals.push_back(std::move(rivals));
  return std::move(ended[0]);
}

std::optional<Found> Search::best_of(const std::vector<Found>& joined, const Found& base) const {
  if (joined.empty() || !(joined[0].cost < base.cost)) return std::nullopt;
  return with_best_of(joined, base);
}

Found Search::without(const Found& found, std::size_t effect) const {
  Point others = found.train.point;
  others.effects.erase(others.effects.begin() + std::ptrdiff_t(effect));
  Found remaining = judge(train_.run(uncertain_, others));
  remaining.rivals = found.rivals;
  remaining.rivals.erase(remaining.rivals.begin() + std::ptrdiff_t(effect));
  return remaining;
}

Found Search::pruned(Found found) const {
  for (std::size_t k = 0; k < found.train.point.effects.size(); ++k)
    if (Found base = without(found, k); base.cost < found.cost) return pruned(std::move(base));
  return found;
}

namespace {

/// Whether the estimate of an effect is compatible with a robot without it: the intervals of all its fitted parameters
/// contain their neutral values.
bool may_be_neutral(const Sized& sized) {
  constexpr double half = 1.96;  // standard deviations
  effects::AnyEffect effect = sized.effect.effect;
  effects::AnyEffect neutral = *effects::neutral(effects::about(effect).type);
  const auto values = effects::parameters(effect), neutrals = effects::parameters(neutral);
  for (std::size_t p = 0, k = 0; p < values.size(); ++p) {
    if (!is_estimated(values[p])) continue;
    const double sigma = sized.sigma[k++];
    if (values[p].fitted && std::abs(*values[p].value - *neutrals[p].value) > half * sigma)
      return false;
  }
  return true;
}

/// For each effect, whether one of its parameters is at a bound, or it may be neutral.
std::vector<bool> doubtful(const Estimate& estimate) {
  std::vector<bool> all;
  std::size_t k = estimate.point.x.size();
  for (const Sized& one : sized(estimate)) {
    bool any = may_be_neutral(one);
    for (std::size_t p = 0; p < one.sigma.size(); ++p) any |= estimate.bound[k++];
    all.push_back(any);
  }
  return all;
}

}  // namespace

Found Search::without_doubtful(Found found) const {
  const std::vector<bool> doubt = doubtful(found.train);
  for (std::size_t k = 0; k < doubt.size(); ++k)
    if (doubt[k])
      if (Found base = without(found, k); !keeps(base)) return without_doubtful(std::move(base));
  return found;
}

/// An earlier choice may have been a compromise between two effects, or superfluous after a later one.
Found Search::exchanged(Found found) const {
  constexpr double improvement = 0.98;  // largest cost / previous cost; chosen
  for (std::size_t k = 0; k + 1 < found.train.point.effects.size(); ++k) {
    const Found base = without(found, k);
    if (base.cost < found.cost) return exchanged(base);
    const auto joined = with_each_candidate(base);
    if (joined.empty()) continue;
    Found other = with_best_of(joined, base);
    if (other.cost < improvement * found.cost)  // another effect, or another minimum of the same
      found = pruned(std::move(other));
    else found.rivals[k] = rivals_of(found, k, other, base.cost);
  }
  return found;
}

Found Search::run(Found found, std::size_t most) const {
  const std::size_t rounds = 2 * most;  // a dropped effect may be found again
  for (std::size_t round = 0;
       round < rounds && keeps(found) && found.train.point.effects.size() < most; ++round) {
    if (options_.progress)
      options_.progress("effects", double(found.train.point.effects.size()) / double(most));
    auto more = with_best_candidate(found);
    if (!more || !relieves(*more, found)) break;
    found = exchanged(std::move(*more));
  }
  return without_doubtful(std::move(found));
}

std::vector<Sized> sized(const Estimate& estimate) {
  std::vector<Sized> all;
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
  constexpr double margin = 4, of_gain = 0.02;  // chosen
  return std::abs(other - cost) < margin + of_gain * gain;
}

std::vector<Sized> indistinguishable(const Found& found, std::size_t effect) {
  const Rivals& rivals = found.rivals[effect];
  std::vector<Sized> all;
  for (std::size_t k = 0; k < rivals.all.size(); ++k)
    if (rivals.cost[k] < found.cost ||
        are_indistinguishable(found.cost, rivals.cost[k], rivals.gain))
      all.push_back(rivals.all[k]);
  return all;
}

}  // namespace sim::estimation

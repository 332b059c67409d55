#include "sim/gap/search.hpp"

#include <algorithm>
#include <cmath>

#include "sim/parallel/in_parallel.hpp"

namespace sim::gap {
namespace {

constexpr double worth = 0.3;  // of a stage's excess that an effect must take away; chosen

/// Of a stage's excess: of little, and of much a small part, for laws are approximations; chosen.
double tolerated(double nominal_excess) { return std::clamp(0.002 * nominal_excess, 0.6, 2.0); }

bool is_same(const effects::Placed& a, const effects::Placed& b) {
  return a.on == b.on && a.effect.index() == b.effect.index();
}

/// Whether it takes a good part of what a stage keeps.
bool relieves(const Found& is, const Found& was) {
  for (std::size_t s = 0; s < was.held_out.excess.size(); ++s) {
    const double before = was.held_out.excess[s];
    if (before > was.tolerated[s] && before - is.held_out.excess[s] > worth * before) return true;
  }
  return false;
}

}  // namespace

std::size_t stages_kept(const Found& found) {
  std::size_t kept = 0;
  for (std::size_t s = 0; s < found.tolerated.size(); ++s)
    kept += std::max(found.on_train.excess[s], found.held_out.excess[s]) > found.tolerated[s];
  return kept;
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
  for (const double e : left_by(residuals, nominal, residuals.z(nominal)).excess)
    tolerated_.push_back(tolerated(e));
}

Found Search::judge(Estimate estimate) const {
  Found found{.train = std::move(estimate), .tolerated = tolerated_};
  found.on_train = left_by(train_.residuals(), found.train.explained, found.train.z);
  const Explained held_out = held_out_.explain(robot_at(uncertain_, found.train.point), 1);
  found.held_out = left_by(held_out_, held_out, held_out_.z(held_out));
  found.cost = misfit(found.on_train, train_.residuals()) + misfit(found.held_out, held_out_) +
               prior_cost(found.train.point);
  return found;
}

Found Search::with(const std::vector<effects::Placed>& effects) const {
  Found found = judge(train_.run(uncertain_, {{}, effects}));
  found.rivals.resize(effects.size());
  return found;
}

std::vector<Found> Search::each_beside(const Found& base) const {
  constexpr int iterations = 4;
  auto candidates = screen_.candidates(base.train);
  if (candidates.size() > options_.estimated) candidates.resize(options_.estimated);
  std::vector<Found> joined(candidates.size());
  in_parallel(candidates.size(), train_.options().threads, [&](std::size_t k) {
    Point start = base.train.point;
    start.effects.push_back(candidates[k].start);
    joined[k] = judge(train_.beside(uncertain_, base.train, std::move(start), iterations));
  });
  std::ranges::stable_sort(joined, {}, &Found::cost);
  return joined;
}

/// The cheapest of `joined` estimated to its end, with those that come near it then.
Found Search::with_best_of(const std::vector<Found>& joined, const Found& base) const {
  constexpr double unsettled =
      0.3;                         // of the gain: that far is one in few steps from its end; chosen
  constexpr std::size_t most = 4;  // chosen
  std::vector<Found> ended;
  for (const Found& one : joined)
    if (ended.size() < most && one.cost < joined[0].cost + unsettled * (base.cost - joined[0].cost))
      ended.push_back(judge(train_.run(uncertain_, one.train.point)));
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

std::optional<Found> Search::best_beside(const Found& base) const {
  const auto joined = each_beside(base);
  if (joined.empty() || !(joined[0].cost < base.cost) || !relieves(joined[0], base))
    return std::nullopt;
  return with_best_of(joined, base);
}

Found Search::without(const Found& found, std::size_t effect) const {
  Point others = found.train.point;
  others.effects.erase(others.effects.begin() + std::ptrdiff_t(effect));
  Found left = judge(train_.run(uncertain_, others));
  left.rivals = found.rivals;
  left.rivals.erase(left.rivals.begin() + std::ptrdiff_t(effect));
  return left;
}

/// An earlier choice may have been a compromise between two.
Found Search::exchanged(Found found) const {
  constexpr double better = 0.98;  // chosen
  for (std::size_t k = 0; k + 1 < found.train.point.effects.size(); ++k) {
    const Found base = without(found, k);
    const auto joined = each_beside(base);
    if (joined.empty()) continue;
    Found other = with_best_of(joined, base);
    if (is_same(other.train.point.effects.back(), found.train.point.effects[k]))
      found.rivals[k] = other.rivals.back();
    else if (other.cost < better * found.cost) found = std::move(other);
  }
  return found;
}

Found Search::run(Found found, std::size_t most) const {
  while (keeps(found) && found.train.point.effects.size() < most) {
    if (options_.progress)
      options_.progress("effects", double(found.train.point.effects.size()) / double(most));
    auto more = best_beside(found);
    if (!more) break;
    found = exchanged(std::move(*more));
  }
  return found;
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

std::vector<Sized> indistinguishable(const Found& found, std::size_t effect) {
  constexpr double margin = 4, of_gain = 0.02;  // chosen
  const Rivals& rivals = found.rivals[effect];
  std::vector<Sized> all;
  for (std::size_t k = 0; k < rivals.all.size(); ++k)
    if (rivals.cost[k] < found.cost + margin + of_gain * rivals.gain) all.push_back(rivals.all[k]);
  return all;
}

}  // namespace sim::gap

#include "sim/gap/estimation/far_rivals.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace sim::estimation {
namespace {

using Eigen::Index;

/// The similarity of two constants' effects on the residuals: the cosine between them, and the number of tolerances of
/// `other` that change as much as one of `k`.
struct Similarity {
  double cosine = 0, ratio = 0;
};

Similarity similarity(const Estimate& e, std::size_t k, std::size_t other) {
  const Eigen::VectorXd of_k = e.jacobian.col(Index(k)), of_other = e.jacobian.col(Index(other));
  const Eigen::VectorXd weighted = e.weight.cwiseProduct(of_k);
  const double dot = weighted.dot(of_other), square = of_other.dot(e.weight.cwiseProduct(of_other));
  const double length = std::sqrt(weighted.dot(of_k) * square);
  return length > 0 ? Similarity{dot / length, dot / square} : Similarity{};
}

/// The constants, not far off, whose effect on the residuals is most similar to that of a constant far off.
std::vector<std::size_t> most_similar(const AsBuilt& built, std::size_t k) {
  constexpr double similar = 0.8;  // chosen
  constexpr std::size_t most = 2;  // chosen
  std::vector<std::pair<double, std::size_t>> all;
  for (std::size_t other = 0; other < built.uncertain.constants.size(); ++other) {
    if (other == k || built.uncertain.far[other] || built.uncertain.constants[other].zero) continue;
    const double cosine = std::abs(similarity(built.estimate, k, other).cosine);
    if (cosine > similar) all.emplace_back(cosine, other);
  }
  std::ranges::sort(all, std::greater());
  all.resize(std::min(most, all.size()));
  std::vector<std::size_t> constants;
  for (const auto& [cosine, other] : all) constants.push_back(other);
  return constants;
}

/// The estimate with a constant far off reset to its nominal value, and another one moved to make the same change.
Point exchanged(const AsBuilt& built, std::size_t k, std::size_t other) {
  constexpr double part = 0.5;  // largest share of the distance to a bound; chosen
  const Constant& c = built.uncertain.constants[other];
  Point point = built.estimate.point;
  const double x = point.x[k] * similarity(built.estimate, k, other).ratio;
  point.x[other] = std::clamp(x, part * (c.lowest - c.nominal) / c.tolerance,
                              part * (c.highest - c.nominal) / c.tolerance);
  point.x[k] = 0;
  return point;
}

Sized as_effect_of(const AsBuilt& built, const Estimate& e, std::size_t k) {
  return as_effect(built.uncertain.constants[k], {k, e.point.x[k], e.sigma(k)});
}

void add_instead(std::vector<Sized>& instead, Sized one) {
  std::erase_if(instead, [&](const Sized& other) {
    return other.effect.on == one.effect.on &&
           other.effect.effect.index() == one.effect.effect.index();
  });
  instead.push_back(std::move(one));
}

/// Estimates `other` as far off instead of the n-th constant far off. Keeps the cheaper of the two; the other one
/// becomes an alternative if it costs little more.
void compare(const Search& search, const Problem& problem, std::size_t n, std::size_t other,
             double gain, Found& found, AsBuilt& built) {
  const std::size_t k = built.beyond[n];
  const auto set_far = [&](std::size_t is, std::size_t is_not) {
    built.uncertain.far[is] = true, built.uncertain.far[is_not] = false;
  };
  set_far(other, k);
  Found rival = search.judge(problem.train.run(built.uncertain, exchanged(built, k, other)));
  rival.rivals = found.rivals;
  const bool is_better = rival.cost < found.cost;
  if (!is_better) set_far(k, other);
  const bool is_near = are_indistinguishable(found.cost, rival.cost, gain);
  const Sized that =
      as_effect_of(built, is_better ? found.train : rival.train, is_better ? k : other);
  if (is_better) {
    found = std::move(rival);
    built.estimate = found.train, built.beyond[n] = other;
    if (!is_near) built.instead[n].clear();
  }
  if (is_near) add_instead(built.instead[n], that);
}

}  // namespace

Found with_rivals_far(const Search& search, Found found, const Problem& problem, double gain,
                      AsBuilt& built) {
  constexpr std::size_t few = 2;  // constants far off; more would need too many estimates; chosen
  if (built.beyond.size() > few) return found;
  for (std::size_t n = 0; n < built.beyond.size(); ++n)
    for (const std::size_t other : most_similar(built, built.beyond[n]))
      if (!built.uncertain.far[other]) compare(search, problem, n, other, gain, found, built);
  return found;
}

}  // namespace sim::estimation

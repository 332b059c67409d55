#include "sim/gap/estimation/far_rivals.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace sim::estimation {
namespace {

using Eigen::Index;

/// The similarity of two constants' sensitivities: the cosine between them, and the number of
/// tolerances of `other` that change the residuals as much as one tolerance of `k`.
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

/// The constants within their tolerances whose sensitivity is most similar to that of a constant
/// far off.
std::vector<std::size_t> most_similar(const AsBuilt& built, std::size_t k) {
  constexpr double smallest_cosine = 0.8;  // chosen
  constexpr std::size_t max_count = 2;     // chosen
  std::vector<std::pair<double, std::size_t>> all;
  for (std::size_t other = 0; other < built.uncertain.constants.size(); ++other) {
    if (other == k || built.uncertain.far[other] || built.uncertain.constants[other].zero) continue;
    const double cosine = std::abs(similarity(built.estimate, k, other).cosine);
    if (cosine > smallest_cosine) all.emplace_back(cosine, other);
  }
  std::ranges::sort(all, std::greater());
  all.resize(std::min(max_count, all.size()));
  std::vector<std::size_t> constants;
  for (const auto& [cosine, other] : all) constants.push_back(other);
  return constants;
}

/// The estimate with constant k reset to its nominal value, and `other` moved to change the
/// residuals in the same way.
Point exchanged(const AsBuilt& built, std::size_t k, std::size_t other) {
  constexpr double part = 0.5;  // largest fraction of the distance to a bound; chosen
  const Constant& c = built.uncertain.constants[other];
  Point point = built.estimate.point;
  const double x = point.x[k] * similarity(built.estimate, k, other).ratio;
  point.x[other] = std::clamp(x, part * (c.lowest - c.nominal) / c.tolerance,
                              part * (c.highest - c.nominal) / c.tolerance);
  point.x[k] = 0;
  return point;
}

SizedEffect as_effect_of(const AsBuilt& built, const Estimate& e, std::size_t k) {
  return as_effect(built.uncertain.constants[k], {k, e.point.x[k], e.sigma(k)});
}

/// Adds an alternative; replaces one of the same type and place.
void add_alternative(std::vector<SizedEffect>& alternatives, SizedEffect one) {
  std::erase_if(alternatives, [&](const SizedEffect& other) {
    return other.effect.on == one.effect.on &&
           other.effect.effect.index() == one.effect.effect.index();
  });
  alternatives.push_back(std::move(one));
}

/// Estimates `other` as far off instead of the n-th constant far off. Stores the cheaper of the
/// two. The other one becomes an alternative if it costs little more.
void compare(const Search& search, const Problem& problem, std::size_t n, std::size_t other,
             double gain, JudgedEstimate& found, AsBuilt& built) {
  const std::size_t k = built.beyond_tolerance[n];
  const auto set_far = [&](std::size_t far, std::size_t not_far) {
    built.uncertain.far[far] = true, built.uncertain.far[not_far] = false;
  };
  set_far(other, k);
  JudgedEstimate rival =
      search.judge(problem.train.run(built.uncertain, exchanged(built, k, other)));
  rival.rivals = found.rivals;
  const bool is_better = rival.cost < found.cost;
  if (!is_better) set_far(k, other);
  const bool is_near = are_indistinguishable(found.cost, rival.cost, gain);
  const SizedEffect loser =
      as_effect_of(built, is_better ? found.train : rival.train, is_better ? k : other);
  if (is_better) {
    found = std::move(rival);
    built.estimate = found.train, built.beyond_tolerance[n] = other;
    if (!is_near) built.alternatives[n].clear();
  }
  if (is_near) add_alternative(built.alternatives[n], loser);
}

}  // namespace

JudgedEstimate with_rivals_far(const Search& search, JudgedEstimate found, const Problem& problem,
                               double gain, AsBuilt& built) {
  constexpr std::size_t max_far = 2;  // more would need too many estimates; chosen
  if (built.beyond_tolerance.size() > max_far) return found;
  for (std::size_t n = 0; n < built.beyond_tolerance.size(); ++n)
    for (const std::size_t other : most_similar(built, built.beyond_tolerance[n]))
      if (!built.uncertain.far[other]) compare(search, problem, n, other, gain, found, built);
  return found;
}

}  // namespace sim::estimation

#pragma once
#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

namespace sim::diagnosis {

struct Interval {
  double low = 0, high = 0;
};

/// Returns the sorted values of `statistic(drawn)` for `draws` resamplings of `count` blocks.
/// `drawn`: `count` indices of blocks, drawn with replacement. Source: Efron 1979; block bootstrap:
/// Künsch 1989.
template <class Statistic>
std::vector<double> bootstrap(std::size_t count, int draws, std::uint64_t seed,
                              Statistic statistic) {
  std::mt19937_64 random(seed);
  std::uniform_int_distribution<std::size_t> block(0, count > 0 ? count - 1 : 0);
  std::vector<double> values;
  std::vector<std::size_t> drawn(count);
  for (int d = 0; d < draws && count > 0; ++d) {
    for (std::size_t& k : drawn) k = block(random);
    values.push_back(statistic(drawn));
  }
  std::ranges::sort(values);
  return values;
}

/// Returns the interval that contains the middle `fraction` of the sorted values.
inline Interval middle(const std::vector<double>& sorted, double fraction = 0.95) {
  if (sorted.empty()) return {};
  const auto quantile = [&](double q) {
    return sorted[static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1) + 0.5)];
  };
  return {quantile((1 - fraction) / 2), quantile((1 + fraction) / 2)};
}

}  // namespace sim::diagnosis

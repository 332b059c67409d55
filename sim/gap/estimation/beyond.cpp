#include "sim/gap/estimation/beyond.hpp"

#include <algorithm>
#include <cmath>

namespace sim::estimation {

void list_uncertain(AsBuilt& built) {
  // Smallest deviations, in tolerances: of a zero, of any other constant; of a zero also in standard errors; chosen.
  constexpr double least_zero = 1, least = 2.5, clear = 5;
  const auto far = [&](std::size_t k) { return std::abs(built.estimate.point.x[k]); };
  const auto from = [&](std::size_t k) {
    return built.uncertain.constants[k].zero ? std::max(least_zero, clear * built.estimate.sigma(k))
                                             : least;
  };
  for (std::size_t k = 0; k < built.uncertain.constants.size(); ++k)
    if (far(k) > from(k) && determined(built, k) > well_determined) built.beyond.push_back(k);
  std::ranges::sort(built.beyond, std::greater(), far);
  built.instead.resize(built.beyond.size());
}

namespace {

/// Removes constants that ended near nominal from those far off. True: some were removed, and the rest must be
/// estimated again.
bool drop_near(AsBuilt& built) {
  bool dropped = false;
  for (std::size_t n = built.beyond.size(); n-- > 0;) {
    const std::size_t k = built.beyond[n];
    if (is_worth_far(built.uncertain.constants[k], built.estimate.point.x[k])) continue;
    built.uncertain.far[k] = false, dropped = true;
    built.beyond.erase(built.beyond.begin() + std::ptrdiff_t(n));
    built.instead.erase(built.instead.begin() + std::ptrdiff_t(n));
  }
  return dropped;
}

}  // namespace

void complete_far_off(const Estimator& estimator, AsBuilt& built) {
  constexpr int rounds = 4;  // of set and estimate in turn; chosen
  for (int round = 0; round < rounds; ++round) {
    FarOff found = far_off(built.uncertain, built.estimate);
    std::vector<bool> far(built.uncertain.constants.size());
    built.beyond.clear();
    for (const Deviation& d : found.all) far[d.constant] = true, built.beyond.push_back(d.constant);
    built.instead.clear();
    for (const auto& instead : found.instead) {
      auto& each = built.instead.emplace_back();
      for (const Deviation& d : instead)
        each.push_back(as_effect(built.uncertain.constants[d.constant], d));
    }
    if (far == built.uncertain.far) break;
    built.uncertain.far = std::move(far);
    built.estimate = estimator.continued(built.uncertain, std::move(built.estimate));
  }
  while (drop_near(built))
    built.estimate = estimator.continued(built.uncertain, std::move(built.estimate));
}

}  // namespace sim::estimation

#include "sim/gap/estimation/beyond.hpp"

#include <algorithm>
#include <cmath>

namespace sim::estimation {

void list_uncertain(AsBuilt& built) {
  // Thresholds of deviations; chosen. In tolerances: of a zero, of any other constant; of a zero
  // also in standard errors.
  constexpr double zero_tolerances = 1, tolerances = 2.5, zero_sigmas = 5;
  const auto deviation = [&](std::size_t k) { return std::abs(built.estimate.point.x[k]); };
  const auto threshold = [&](std::size_t k) {
    return built.uncertain.constants[k].zero
               ? std::max(zero_tolerances, zero_sigmas * built.estimate.sigma(k))
               : tolerances;
  };
  for (std::size_t k = 0; k < built.uncertain.constants.size(); ++k)
    if (deviation(k) > threshold(k) && determined(built, k) > determined_threshold)
      built.beyond_tolerance.push_back(k);
  std::ranges::sort(built.beyond_tolerance, std::greater(), deviation);
  built.alternatives.resize(built.beyond_tolerance.size());
}

namespace {

/// Removes the constants whose estimate is near nominal from those far off. Returns whether a
/// constant was removed; then all constants must be estimated again.
bool remove_near_nominal(AsBuilt& built) {
  bool removed = false;
  for (std::size_t n = built.beyond_tolerance.size(); n-- > 0;) {
    const std::size_t k = built.beyond_tolerance[n];
    if (is_worth_far(built.uncertain.constants[k], built.estimate.point.x[k])) continue;
    built.uncertain.far[k] = false, removed = true;
    built.beyond_tolerance.erase(built.beyond_tolerance.begin() + std::ptrdiff_t(n));
    built.alternatives.erase(built.alternatives.begin() + std::ptrdiff_t(n));
  }
  return removed;
}

}  // namespace

void complete_far_off(const Estimator& estimator, AsBuilt& built) {
  constexpr int rounds = 4;  // of selection and estimate; chosen
  for (int round = 0; round < rounds; ++round) {
    FarOff selection = far_off(built.uncertain, built.estimate);
    std::vector<bool> far(built.uncertain.constants.size());
    built.beyond_tolerance.clear();
    for (const Deviation& d : selection.all)
      far[d.constant] = true, built.beyond_tolerance.push_back(d.constant);
    built.alternatives.clear();
    for (const auto& alternatives : selection.alternatives) {
      auto& each = built.alternatives.emplace_back();
      for (const Deviation& d : alternatives)
        each.push_back(as_effect(built.uncertain.constants[d.constant], d));
    }
    if (far == built.uncertain.far) break;
    built.uncertain.far = std::move(far);
    built.estimate = estimator.continued(built.uncertain, std::move(built.estimate));
  }
  while (remove_near_nominal(built))
    built.estimate = estimator.continued(built.uncertain, std::move(built.estimate));
}

}  // namespace sim::estimation

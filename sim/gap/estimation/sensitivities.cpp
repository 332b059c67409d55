#include "sim/gap/estimation/sensitivities.hpp"

#include <algorithm>
#include <cmath>

#include "sim/gap/estimation/periods.hpp"

namespace sim::estimation {

using effects::Placed;
using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// Whether a parameter is a shape parameter: its lower bound is above 0.
bool is_shape(const effects::Parameter& p) { return p.bounds.low > 0; }

/// Values at which a shape parameter is scanned, spaced logarithmically.
std::vector<double> grid(const effects::Parameter& p) {
  std::vector<double> values;
  constexpr int points = 7;  // chosen
  for (int n = 0; n < points; ++n)
    values.push_back(p.bounds.low * std::pow(p.bounds.high / p.bounds.low, (n + 0.5) / points));
  return values;
}

struct Perturbed {
  double by;
  VectorXd change;  ///< of z
};

Perturbed perturbed(const Placed& shape, std::size_t size, double by, const ChangedBy& changed_by) {
  Placed placed = shape;
  *effects::parameters(placed.effect)[size].value += by;
  return {by, changed_by(placed)};
}

/// A perturbation of a size that changes z by a small part of its noise, independent of the
/// parameter's bounds. `by`: the initial perturbation. It is used if it does not change z.
Perturbed fitting_perturbation(const Placed& shape, std::size_t size, double by,
                               const ChangedBy& changed_by) {
  constexpr double desired_rms = 0.003, min_scale = 1e-6, max_scale = 100;  // chosen
  constexpr double near_scale = 4;  // within this factor the first perturbation is used; chosen
  Perturbed first = perturbed(shape, size, by, changed_by);
  const double rms = first.change.norm() / std::sqrt(double(first.change.size()));
  const double scale = std::clamp(desired_rms / std::max(rms, 1e-12), min_scale, max_scale);
  if (rms == 0 || (scale > 1 / near_scale && scale < near_scale)) return first;
  Placed placed = shape;
  const effects::Parameter p = effects::parameters(placed.effect)[size];
  return perturbed(shape, size, std::min(by * scale, p.bounds.high - *p.value), changed_by);
}

}  // namespace

std::vector<Placed> shaped(const Placed& neutral, const std::vector<double>& periods) {
  std::vector<Placed> all;
  effects::AnyEffect probe = neutral.effect;
  const auto parameters = effects::parameters(probe);
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    if (!is_shape(parameters[p])) continue;
    const bool counts = counts_periods(parameters[p]);
    if (!counts) all.push_back(neutral);
    for (const double value : counts ? periods : grid(parameters[p])) {
      all.push_back(neutral);
      *effects::parameters(all.back().effect)[p].value = value;
    }
    break;
  }
  if (all.empty()) all.push_back(neutral);
  return all;
}

bool is_like(const effects::Parameter& p, const effects::Parameter& first) {
  return p.bounds.high == first.bounds.high;
}

Sensitivities sensitivities(const Placed& shape, const std::vector<std::size_t>& sizes,
                            std::vector<double>& by, const ChangedBy& changed_by) {
  Sensitivities all{shape, sizes, {}, {}};
  effects::AnyEffect probe = shape.effect;
  const auto parameters = effects::parameters(probe);
  for (std::size_t n = 0; n < sizes.size(); ++n) {
    const bool is_amplitude = is_like(parameters[sizes[n]], parameters[sizes[0]]);
    Placed center = shape;
    if (!is_amplitude) *effects::parameters(center.effect)[sizes[0]].value += by[0];
    Perturbed one = is_amplitude ? fitting_perturbation(shape, sizes[n], by[n], changed_by)
                                 : perturbed(center, sizes[n], by[n], changed_by);
    by[n] = one.by;
    if (n == 0) all.d.resize(one.change.size(), Index(sizes.size()));
    all.d.col(Index(n)) = one.change;
    if (!is_amplitude) all.d.col(Index(n)) -= all.d.col(0);
  }
  all.perturbation = by;
  return all;
}

std::vector<Sensitivities> secants(const Placed& shape, const std::vector<std::size_t>& sizes,
                                   const ChangedBy& changed_by) {
  constexpr double fractions_of_bound[] = {0.03, 0.2};  // chosen
  effects::AnyEffect probe = shape.effect;
  const auto parameters = effects::parameters(probe);
  std::vector<Sensitivities> all;
  if (sizes.size() != 1 || parameters[sizes[0]].bounds.low != 0 ||
      std::ranges::any_of(parameters, is_shape) ||
      effects::about(shape.effect).stage == effects::Stage::skeleton)
    return all;
  for (const double fraction : fractions_of_bound) {
    const double by = fraction * parameters[sizes[0]].bounds.high;
    all.push_back({shape, sizes, {by}, perturbed(shape, sizes[0], by, changed_by).change});
  }
  return all;
}

std::vector<std::size_t> sizes_of(const Placed& neutral) {
  std::vector<std::size_t> sizes;
  effects::AnyEffect probe = neutral.effect;
  const auto parameters = effects::parameters(probe);
  for (std::size_t p = 0; p < parameters.size(); ++p)
    if (!is_shape(parameters[p]) && parameters[p].fitted) sizes.push_back(p);
  return sizes;
}

std::vector<double> first_perturbations(const Placed& neutral,
                                        const std::vector<std::size_t>& sizes) {
  constexpr double amplitude_fraction = 3e-3, position_fraction = 0.03;  // of the bounds; chosen
  effects::AnyEffect probe = neutral.effect;
  const auto parameters = effects::parameters(probe);
  std::vector<double> by;
  for (const std::size_t p : sizes) {
    const effects::Bounds bounds = parameters[p].bounds;
    const double range = bounds.high > 0 ? bounds.high : bounds.low;
    by.push_back(is_like(parameters[p], parameters[sizes[0]]) ? amplitude_fraction * range
                                                              : position_fraction * bounds.high);
  }
  return by;
}

}  // namespace sim::estimation

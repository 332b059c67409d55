#include "sim/gap/estimation/sensitivities.hpp"

#include <algorithm>
#include <cmath>

#include "sim/gap/estimation/periods.hpp"

namespace sim::estimation {

using effects::Placed;
using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// Whether a parameter shapes a law. Without it the law's size has no meaning.
bool shapes(const effects::Parameter& p) { return p.bounds.low > 0; }

/// Values at which a parameter that shapes a law is scanned.
std::vector<double> grid(const effects::Parameter& p) {
  std::vector<double> values;
  constexpr int points = 7;
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

/// A perturbation of a size that changes z by a small part of its noise, independent of the parameter's bounds. `by`:
/// the initial perturbation, which is kept if it changes nothing.
Perturbed fitting_perturbation(const Placed& shape, std::size_t size, double by,
                               const ChangedBy& changed_by) {
  constexpr double desired = 0.003, least = 1e-6, most = 100, near = 4;  // chosen
  Perturbed first = perturbed(shape, size, by, changed_by);
  const double rms = first.change.norm() / std::sqrt(double(first.change.size()));
  const double scale = std::clamp(desired / std::max(rms, 1e-12), least, most);
  if (rms == 0 || (scale > 1 / near && scale < near)) return first;
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
    if (!shapes(parameters[p])) continue;
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
    const bool like = is_like(parameters[sizes[n]], parameters[sizes[0]]);
    Placed around = shape;
    if (!like) *effects::parameters(around.effect)[sizes[0]].value += by[0];
    Perturbed one = like ? fitting_perturbation(shape, sizes[n], by[n], changed_by)
                         : perturbed(around, sizes[n], by[n], changed_by);
    by[n] = one.by;
    if (n == 0) all.d.resize(one.change.size(), Index(sizes.size()));
    all.d.col(Index(n)) = one.change;
    if (!like) all.d.col(Index(n)) -= all.d.col(0);
  }
  all.perturbation = by;
  return all;
}

std::vector<Sensitivities> secants(const Placed& shape, const std::vector<std::size_t>& sizes,
                                   const ChangedBy& changed_by) {
  constexpr double of_bounds[] = {0.03, 0.2};  // chosen
  effects::AnyEffect probe = shape.effect;
  const auto parameters = effects::parameters(probe);
  std::vector<Sensitivities> all;
  if (sizes.size() != 1 || parameters[sizes[0]].bounds.low != 0 ||
      std::ranges::any_of(parameters, shapes) ||
      effects::about(shape.effect).stage == effects::Stage::skeleton)
    return all;
  for (const double share : of_bounds) {
    const double by = share * parameters[sizes[0]].bounds.high;
    all.push_back({shape, sizes, {by}, perturbed(shape, sizes[0], by, changed_by).change});
  }
  return all;
}

std::vector<std::size_t> sizes_of(const Placed& neutral) {
  std::vector<std::size_t> sizes;
  effects::AnyEffect probe = neutral.effect;
  const auto parameters = effects::parameters(probe);
  for (std::size_t p = 0; p < parameters.size(); ++p)
    if (!shapes(parameters[p]) && parameters[p].fitted) sizes.push_back(p);
  return sizes;
}

std::vector<double> first_perturbations(const Placed& neutral,
                                        const std::vector<std::size_t>& sizes) {
  constexpr double of_bounds = 3e-3, of_place = 0.03;  // chosen
  effects::AnyEffect probe = neutral.effect;
  const auto parameters = effects::parameters(probe);
  std::vector<double> by;
  for (const std::size_t p : sizes) {
    const effects::Bounds bounds = parameters[p].bounds;
    const double reach = bounds.high > 0 ? bounds.high : bounds.low;
    by.push_back(is_like(parameters[p], parameters[sizes[0]]) ? of_bounds * reach
                                                              : of_place * bounds.high);
  }
  return by;
}

}  // namespace sim::estimation

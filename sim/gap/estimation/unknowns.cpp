#include "sim/gap/estimation/unknowns.hpp"

#include <algorithm>
#include <cmath>

namespace sim::estimation {

erp::Robot robot_at(const Uncertain& uncertain, const Point& point) {
  erp::Robot robot = with_constants(uncertain.nominal, uncertain.constants, point.x);
  for (const effects::Placed& placed : point.effects)
    robot.effects.push_back(effects::written(placed));
  return robot;
}

namespace {
constexpr double nu = 6;  // degrees of freedom of Student's t; chosen
}

double prior_cost(const Uncertain& uncertain, const Point& point) {
  double sum = 0;
  for (std::size_t k = 0; k < point.x.size(); ++k) {
    const double square = point.x[k] * point.x[k];
    if (uncertain.far.empty()) sum += nu * std::log1p(square / nu);
    else if (!uncertain.far[k]) sum += square;
    else sum += far_precision(uncertain.constants[k]) * square + far_price(uncertain.constants[k]);
  }
  return sum;
}

double prior_precision(const Uncertain& uncertain, const Point& point, std::size_t k) {
  if (uncertain.far.empty()) return 1 / (1 + point.x[k] * point.x[k] / nu);
  return uncertain.far[k] ? far_precision(uncertain.constants[k]) : 1;
}

bool is_estimated(const effects::Parameter& p) {
  return p.fitted || (p.bounds.low > 0 && std::string_view(p.name) != "periods_per_turn");
}

Unknowns::Unknowns(const Uncertain& uncertain, Point at)
    : uncertain_(&uncertain), at_(std::move(at)) {
  at_.x.resize(uncertain.constants.size(), 0.0);
  for (std::size_t n = 0; n < at_.effects.size(); ++n) {
    const auto all = effects::parameters(at_.effects[n].effect);
    for (std::size_t p = 0; p < all.size(); ++p)
      if (is_estimated(all[p])) places_.push_back({n, p});
  }
}

effects::Parameter Unknowns::parameter(std::size_t k) const {
  const Place& place = places_[k - constants()];
  auto& effect = const_cast<effects::AnyEffect&>(at_.effects[place.effect].effect);
  return effects::parameters(effect)[place.parameter];
}

double Unknowns::value(std::size_t k) const {
  if (k < constants()) return at_.x[k];
  const effects::Parameter p = parameter(k);
  return p.fitted ? *p.value : std::log(*p.value);
}

double Unknowns::step(std::size_t k, double stretch) const {
  // Steps, in tolerances of constants, and relative to bound and value of parameters; chosen.
  constexpr double of_tolerance = 1e-4, of_bounds = 5e-7, of_value = 1e-5, of_logarithm = 1.5e-5;
  if (k < constants()) return stretch * of_tolerance;
  const effects::Bounds bounds = parameter(k).bounds;
  if (!parameter(k).fitted) {
    const double step = stretch * of_logarithm;
    return value(k) + step > std::log(bounds.high) ? -step : step;
  }
  const double value_step = of_value * std::abs(value(k));
  const double step =
      stretch *
      (value_step > 0 ? value_step : of_bounds * std::max(std::abs(bounds.low), bounds.high));
  return value(k) + step > bounds.high ? -step : step;
}

Unknowns Unknowns::with(std::size_t k, double value) const {
  Unknowns other = *this;
  if (k < constants()) other.at_.x[k] = value;
  else {
    const effects::Parameter p = other.parameter(k);
    *p.value = std::clamp(p.fitted ? value : std::exp(value), p.bounds.low, p.bounds.high);
  }
  return other;
}

Unknowns Unknowns::moved(const Eigen::VectorXd& by) const {
  Unknowns other = *this;
  for (std::size_t k = 0; k < count(); ++k) {
    const double step = by[Eigen::Index(k)];
    other = other.with(
        k, k < constants() ? uncertain_->constants[k].moved(value(k), step) : value(k) + step);
  }
  return other;
}

residuals::Reach Unknowns::reach(std::size_t k, const residuals::Stages& stages) const {
  return k < constants() ? uncertain_->constants[k].reach
                         : stages.reach(at_.effects[places_[k - constants()].effect]);
}

bool Unknowns::at_bound(std::size_t k) const {
  if (k < constants() || is_logarithm(k)) return false;
  const effects::Parameter p = parameter(k);
  const double margin = 1e-3 * (p.bounds.high - p.bounds.low);
  return *p.value > p.bounds.high - margin ||
         (*p.value < p.bounds.low + margin && p.bounds.low != 0);
}

}  // namespace sim::estimation

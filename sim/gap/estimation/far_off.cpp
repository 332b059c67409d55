#include "sim/gap/estimation/far_off.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

namespace sim::estimation {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Set = std::vector<std::size_t>;

/// The minimum of the linear model for a set of constants that are far off. cost: −2 log of its
/// evidence.
struct Minimum {
  VectorXd x;
  MatrixXd covariance;
  double cost = 0;
};

class LinearModel {
 public:
  LinearModel(const Uncertain& uncertain, const Estimate& e)
      : uncertain_(uncertain), estimate_(VectorXd::Zero(e.jacobian.cols())) {
    const auto weighted = e.weight.asDiagonal() * e.jacobian;
    hessian_ = MatrixXd(e.jacobian.transpose() * weighted);
    gradient_ = e.jacobian.transpose() * e.weight.cwiseProduct(e.z);
    for (std::size_t k = 0; k < constants(); ++k) estimate_[Index(k)] = e.point.x[k];
  }

  std::size_t constants() const { return uncertain_.constants.size(); }

  Minimum minimum(const Set& far) const {
    VectorXd prior = VectorXd::Zero(hessian_.rows());
    for (Index k = 0; k < prior.size(); ++k)
      prior[k] = std::size_t(k) < constants() ? 1 : 1e-9 * hessian_(k, k) + 1e-12;
    Minimum m;
    for (const std::size_t k : far)
      prior[Index(k)] = far_precision(constant(k)), m.cost += far_price(constant(k));
    MatrixXd a = hessian_;
    a.diagonal() += prior;
    const auto factors = a.ldlt();
    m.covariance = factors.solve(MatrixXd::Identity(a.rows(), a.cols()));
    m.cost += factors.vectorD().array().log().sum();
    m.x = m.covariance * (hessian_ * estimate_ - gradient_);
    const VectorXd change = m.x - estimate_;
    m.cost += change.dot(hessian_ * change + 2 * gradient_) + m.x.dot(prior.cwiseProduct(m.x));
    return m;
  }

  /// Cost with an additional constant in the set. Subtraction of δ x_k² from a quadratic form
  /// lowers its minimum by δ x_k²/(1 − δ C_kk) and multiplies its determinant by 1 − δ C_kk
  /// (Sherman and Morrison).
  double with(const Minimum& m, std::size_t k) const {
    const double precision_change = 1 - far_precision(constant(k)), x = m.x[Index(k)];
    const double remaining = 1 - precision_change * m.covariance(Index(k), Index(k));
    return m.cost + far_price(constant(k)) + std::log(remaining) -
           precision_change * x * x / remaining;
  }

  /// Whether the value of the constant would be above its lower bound if it were far off.
  bool may_be_far(const Minimum& m, std::size_t k) const {
    const double remaining =
        1 - (1 - far_precision(constant(k))) * m.covariance(Index(k), Index(k));
    return constant(k).nominal + constant(k).tolerance * m.x[Index(k)] / remaining >
           constant(k).lowest;
  }

 private:
  const Constant& constant(std::size_t k) const { return uncertain_.constants[k]; }

  const Uncertain& uncertain_;
  VectorXd estimate_, gradient_;
  MatrixXd hessian_;
};

/// The constant whose addition gives the lowest cost, and that cost; infinite if no constant can be
/// added.
std::pair<std::size_t, double> cheapest(const LinearModel& model, const Minimum& m,
                                        const Set& far) {
  std::pair<std::size_t, double> best{0, std::numeric_limits<double>::infinity()};
  for (std::size_t k = 0; k < model.constants(); ++k)
    if (std::ranges::count(far, k) == 0 && model.may_be_far(m, k))
      if (const double cost = model.with(m, k); cost < best.second) best = {k, cost};
  return best;
}

Set without(Set far, std::size_t k) {
  std::erase(far, k);
  return far;
}

constexpr double rounding_error = 1e-9;  // of a cost

/// Removes a constant if the cost without it is lower. Returns whether one was removed.
bool remove_one(const LinearModel& model, Set& far, Minimum& m) {
  for (const std::size_t k : far) {
    const Set others = without(far, k);
    Minimum reduced = model.minimum(others);
    if (!(reduced.cost < m.cost - rounding_error)) continue;
    far = others, m = std::move(reduced);
    return true;
  }
  return false;
}

/// Replaces a constant by another one if that costs less. Returns whether one was replaced.
bool replace_one(const LinearModel& model, Set& far, Minimum& m) {
  for (std::size_t& k : far) {
    const Set others = without(far, k);
    const auto [other, cost] = cheapest(model, model.minimum(others), others);
    if (other == k || !(cost < m.cost - rounding_error)) continue;
    k = other, m = model.minimum(far);
    return true;
  }
  return false;
}

Deviation deviation(const Minimum& m, std::size_t k) {
  return {k, m.x[Index(k)], std::sqrt(m.covariance(Index(k), Index(k)))};
}

/// The constants that could replace constant k of the set at little more cost, the cheapest first.
std::vector<Deviation> alternatives_to(const LinearModel& model, const Set& far, double cost,
                                       std::size_t k) {
  constexpr double margin = 4;  // of the cost; chosen
  const Set others = without(far, k);
  const Minimum m = model.minimum(others);
  std::vector<std::pair<double, Deviation>> candidates;
  for (std::size_t other = 0; other < model.constants(); ++other) {
    if (other == k || std::ranges::count(far, other) || !model.may_be_far(m, other)) continue;
    if (const double with = model.with(m, other); with < cost + margin) {
      Set set = others;
      set.push_back(other);
      candidates.emplace_back(with, deviation(model.minimum(set), other));
    }
  }
  std::ranges::sort(candidates, {}, [](const auto& n) { return n.first; });
  std::vector<Deviation> alternatives;
  for (const auto& [with, other] : candidates) alternatives.push_back(other);
  return alternatives;
}

}  // namespace

SizedEffect as_effect(const Constant& c, const Deviation& d) {
  effects::Placed placed{c.on, *effects::neutral(c.effect)};
  const effects::Parameter p = effects::parameters(placed.effect)[0];
  *p.value = std::clamp(c.effect_scale * (c.value(d.x) - c.nominal), p.bounds.low, p.bounds.high);
  SizedEffect effect{placed, {std::abs(c.effect_scale) * c.tolerance * d.sigma}};
  for (const effects::Parameter& other : effects::parameters(placed.effect))
    if (estimation::is_estimated(other) && other.value != p.value) effect.sigma.push_back(0);
  return effect;
}

bool is_worth_far(const Constant& c, double x) {
  return x * x * (1 - far_precision(c)) > far_price(c) - 2 * std::log(c.far_sigma);
}

FarOff far_off(const Uncertain& uncertain, const Estimate& estimate) {
  const LinearModel model(uncertain, estimate);
  Set far;
  Minimum m = model.minimum(far);
  while (far.size() < model.constants()) {
    const auto [k, cost] = cheapest(model, m, far);
    if (!(cost < m.cost)) break;
    far.push_back(k), m = model.minimum(far);
    while (remove_one(model, far, m) || replace_one(model, far, m)) {
    }
  }
  std::ranges::sort(far, std::greater(), [&](std::size_t k) { return std::abs(m.x[Index(k)]); });
  FarOff found;
  for (const std::size_t k : far) {
    found.all.push_back(deviation(m, k));
    found.alternatives.push_back(alternatives_to(model, far, m.cost, k));
  }
  return found;
}

}  // namespace sim::estimation

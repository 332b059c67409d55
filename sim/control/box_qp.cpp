#include "sim/control/box_qp.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace sim {

BoxQp::BoxQp(Eigen::Index unknowns)
    : n_(unknowns),
      tableau_(unknowns, unknowns),
      x_(unknowns),
      w_(unknowns),
      column_(unknowns),
      active_(static_cast<std::size_t>(unknowns), Bound::free) {}

const BoxQp::Vector& BoxQp::solve(const Matrix& h, const Vector& c, const Vector& low,
                                  const Vector& high) {
  check(low, high);
  changes_ = 0;
  sweep_free_variables(h);
  do solve_active_set(c, low, high);
  while (release_wrong_signs());
  converged_ = true;
  for (Eigen::Index p = most_violated(low, high); p >= 0; p = most_violated(low, high)) {
    converged_ = changes_ < max_changes_per_unknown * n_;
    if (!converged_) break;
    const bool below = x_[p] < low[p];
    activate(p, below ? low[p] : high[p], below ? Bound::at_low : Bound::at_high);
  }
  x_ = x_.cwiseMax(low).cwiseMin(high);
  return x_;
}

void BoxQp::check(const Vector& low, const Vector& high) const {
  for (Eigen::Index k = 0; k < n_; ++k)
    if (!(low[k] <= high[k])) throw std::invalid_argument("a lower bound is above its upper bound");
}

// ---- tableau ----

/// Moves variable k from the active set to the free set, or back:
///   T_ij −= T_ik T_kj / T_kk,   T_ik → ± T_ik / T_kk,   T_kk → −1 / T_kk     + if k becomes free
void BoxQp::sweep(Eigen::Index k) {
  const double pivot = tableau_(k, k);
  const bool becomes_free = pivot > 0;
  column_ = tableau_.col(k);
  column_[k] = 0;
  const double inverse = 1 / pivot;
  for (Eigen::Index j = 0; j < n_; ++j)
    if (column_[j] != 0) tableau_.col(j) -= (column_[j] * inverse) * column_;
  column_ *= becomes_free ? inverse : -inverse;
  column_[k] = -inverse;
  tableau_.col(k) = column_;
  tableau_.row(k) = column_.transpose();
}

void BoxQp::sweep_free_variables(const Matrix& h) {
  tableau_ = h;
  for (Eigen::Index k = 0; k < n_; ++k) {
    if (!is_free(k)) continue;
    if (!(tableau_(k, k) > 0)) throw std::invalid_argument("H is not positive definite");
    sweep(k);
  }
}

// ---- bounds ----

/// x_F = H_FF⁻¹ (c_F − H_FB x_B),   w_B = (H_BB − H_BF H_FF⁻¹ H_FB) x_B + H_BF H_FF⁻¹ c_F − c_B
void BoxQp::solve_active_set(const Vector& c, const Vector& low, const Vector& high) {
  for (Eigen::Index k = 0; k < n_; ++k)
    column_[k] = is_free(k) ? c[k] : active(k) == Bound::at_low ? low[k] : high[k];
  w_.noalias() = tableau_ * column_;
  for (Eigen::Index k = 0; k < n_; ++k)
    if (is_free(k)) x_[k] = -w_[k], w_[k] = 0;
    else x_[k] = column_[k], w_[k] -= c[k];
}

/// Releases bounds of the previous active set whose multipliers have the wrong sign.
bool BoxQp::release_wrong_signs() {
  bool released = false;
  for (Eigen::Index k = 0; k < n_; ++k) {
    if (is_free(k) || (active(k) == Bound::at_low ? w_[k] >= 0 : w_[k] <= 0)) continue;
    active(k) = Bound::free;
    sweep(k);
    ++changes_;
    released = true;
  }
  return released;
}

Eigen::Index BoxQp::most_violated(const Vector& low, const Vector& high) const {
  constexpr double relative_rounding = 1e-12;
  Eigen::Index worst = -1;
  double largest_violation = 0;
  for (Eigen::Index k = 0; k < n_; ++k) {
    if (!is_free(k)) continue;
    const double violation = std::max(low[k] - x_[k], x_[k] - high[k]);
    const double rounding = relative_rounding * std::max(1.0, std::abs(x_[k]));
    if (violation > rounding && violation > largest_violation)
      largest_violation = violation, worst = k;
  }
  return worst;
}

/// Moves x_p to its bound. With h = (H_FF⁻¹)_pp and step δ of x_p:
///   δx_F = (H_FF⁻¹)_Fp δ / h,   δw_B = (H_BF H_FF⁻¹)_Bp δ / h,   δw_p = δ / h
void BoxQp::activate(Eigen::Index p, double bound, Bound side) {
  for (;;) {
    const double h = -tableau_(p, p), distance_to_bound = bound - x_[p];
    double step = distance_to_bound;
    Eigen::Index leaving = -1;
    for (Eigen::Index b = 0; b < n_; ++b) {
      if (is_free(b)) continue;
      const double until_zero = -w_[b] * h / tableau_(b, p);
      const bool decreases = active(b) == Bound::at_low ? tableau_(b, p) * distance_to_bound < 0
                                                        : tableau_(b, p) * distance_to_bound > 0;
      if (decreases && std::abs(until_zero) < std::abs(step)) step = until_zero, leaving = b;
    }
    for (Eigen::Index k = 0; k < n_; ++k)
      if (is_free(k)) x_[k] -= tableau_(k, p) * step / h;
      else w_[k] += tableau_(k, p) * step / h;
    w_[p] += step / h;
    ++changes_;
    if (leaving < 0) break;
    w_[leaving] = 0;
    active(leaving) = Bound::free;
    sweep(leaving);
  }
  x_[p] = bound;
  active(p) = side;
  sweep(p);
}

}  // namespace sim

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
      held_(static_cast<std::size_t>(unknowns), Held::free) {}

const BoxQp::Vector& BoxQp::solve(const Matrix& h, const Vector& c, const Vector& low,
                                  const Vector& high) {
  check(low, high);
  changes_ = 0;
  free_all_but_held(h);
  do solve_held(c, low, high);
  while (release_wrong_signs());
  settled_ = true;
  for (Eigen::Index p = most_violated(low, high); p >= 0; p = most_violated(low, high)) {
    settled_ = changes_ < max_changes_per_unknown * n_;
    if (!settled_) break;
    const bool below = x_[p] < low[p];
    activate(p, below ? low[p] : high[p], below ? Held::at_low : Held::at_high);
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
  const bool into_free = pivot > 0;
  column_ = tableau_.col(k);
  column_[k] = 0;
  const double inverse = 1 / pivot;
  for (Eigen::Index j = 0; j < n_; ++j)
    if (column_[j] != 0) tableau_.col(j) -= (column_[j] * inverse) * column_;
  column_ *= into_free ? inverse : -inverse;
  column_[k] = -inverse;
  tableau_.col(k) = column_;
  tableau_.row(k) = column_.transpose();
}

void BoxQp::free_all_but_held(const Matrix& h) {
  tableau_ = h;
  for (Eigen::Index k = 0; k < n_; ++k) {
    if (!is_free(k)) continue;
    if (!(tableau_(k, k) > 0)) throw std::invalid_argument("H is not positive definite");
    sweep(k);
  }
}

// ---- bounds ----

/// x_F = H_FF⁻¹ (c_F − H_FB x_B),   w_B = (H_BB − H_BF H_FF⁻¹ H_FB) x_B + H_BF H_FF⁻¹ c_F − c_B
void BoxQp::solve_held(const Vector& c, const Vector& low, const Vector& high) {
  for (Eigen::Index k = 0; k < n_; ++k)
    column_[k] = is_free(k) ? c[k] : held(k) == Held::at_low ? low[k] : high[k];
  w_.noalias() = tableau_ * column_;
  for (Eigen::Index k = 0; k < n_; ++k)
    if (is_free(k)) x_[k] = -w_[k], w_[k] = 0;
    else x_[k] = column_[k], w_[k] -= c[k];
}

/// Releases bounds of the previous active set whose multipliers have the wrong sign.
bool BoxQp::release_wrong_signs() {
  bool any = false;
  for (Eigen::Index k = 0; k < n_; ++k) {
    if (is_free(k) || (held(k) == Held::at_low ? w_[k] >= 0 : w_[k] <= 0)) continue;
    held(k) = Held::free;
    sweep(k);
    ++changes_;
    any = true;
  }
  return any;
}

Eigen::Index BoxQp::most_violated(const Vector& low, const Vector& high) const {
  Eigen::Index worst = -1;
  double most = 0;
  for (Eigen::Index k = 0; k < n_; ++k) {
    if (!is_free(k)) continue;
    const double beyond = std::max(low[k] - x_[k], x_[k] - high[k]);
    const double rounding = 1e-12 * std::max(1.0, std::abs(x_[k]));
    if (beyond > rounding && beyond > most) most = beyond, worst = k;
  }
  return worst;
}

/// Moves x_p to its bound. With h = (H_FF⁻¹)_pp and step δ of x_p:
///   δx_F = (H_FF⁻¹)_Fp δ / h,   δw_B = (H_BF H_FF⁻¹)_Bp δ / h,   δw_p = δ / h
void BoxQp::activate(Eigen::Index p, double bound, Held side) {
  for (;;) {
    const double h = -tableau_(p, p), whole = bound - x_[p];
    double step = whole;
    Eigen::Index leaving = -1;
    for (Eigen::Index b = 0; b < n_; ++b) {
      if (is_free(b)) continue;
      const double until_zero = -w_[b] * h / tableau_(b, p);
      const bool falls =
          held(b) == Held::at_low ? tableau_(b, p) * whole < 0 : tableau_(b, p) * whole > 0;
      if (falls && std::abs(until_zero) < std::abs(step)) step = until_zero, leaving = b;
    }
    for (Eigen::Index k = 0; k < n_; ++k)
      if (is_free(k)) x_[k] -= tableau_(k, p) * step / h;
      else w_[k] += tableau_(k, p) * step / h;
    w_[p] += step / h;
    ++changes_;
    if (leaving < 0) break;
    w_[leaving] = 0;
    held(leaving) = Held::free;
    sweep(leaving);
  }
  x_[p] = bound;
  held(p) = side;
  sweep(p);
}

}  // namespace sim

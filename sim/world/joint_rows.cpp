#include "sim/world/joint_rows.hpp"

#include <algorithm>
#include <cmath>

namespace sim {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int max_sweeps = 200, max_newton = 60;
constexpr double rest_rad_per_s = 1e-13;  // a sweep that changes less is the last
constexpr double erp_of_overrun = 0.2;    // how much of an overrun limit is undone a step; chosen

/// v⁺ of one coordinate: (1 + w a) v⁺ + w c sgn v⁺ ∋ v.
double rub(double v, double w, double a, double c) {
  const double driven = std::abs(v) - w * c;
  return driven > 0 ? std::copysign(driven / (1 + w * a), v) : 0.0;
}

/// v⁺ of three in W's own axes, W = diag λ: (1 + (a + c/s) λ_i) v⁺_i = v_i, s = |v⁺|, or 0 where
/// the impulse v/λ is within c. s is the zero of φ(s) = Σ (v_i / (s (1 + a λ_i) + c λ_i))² − 1,
/// which falls and is convex: Newton from 0 climbs to it without overshooting.
Vector3d rub(const Vector3d& v, const Vector3d& w, double a, double c) {
  const Eigen::Array3d slope = 1 + a * w.array(), offset = c * w.array();
  if (c <= 0) return v.array() / slope;
  if ((v.array() / offset).matrix().squaredNorm() <= 1) return Vector3d::Zero();
  double speed = 0;
  for (int k = 0; k < max_newton; ++k) {
    const Eigen::Array3d below = speed * slope + offset, part = (v.array() / below).square();
    const double change = (part.sum() - 1) / (2 * (part * slope / below).sum());
    speed += change;
    if (change <= 1e-15 * speed) break;
  }
  return speed * v.array() / (speed * slope + offset);
}

}  // namespace

JointRows::JointRows(std::vector<JointFriction> frictions, int coordinates)
    : frictions_(std::move(frictions)),
      impulses_(frictions_.size(), Vector3d::Zero()),
      axes_(frictions_.size()) {
  limit_impulses_.reserve(static_cast<std::size_t>(2 * coordinates));
}

double JointRows::relax(const JointFriction& f, Vector3d& impulse, const Axes& axes,
                        const Eigen::MatrixXd& w, double dt, Eigen::VectorXd& v) const {
  const double a = f.viscous_Nm_s_per_rad * dt, c = f.coulomb_Nm * dt;
  Vector3d change = Vector3d::Zero();
  if (f.dofs == 1) {
    const double own = w(f.first, f.first), without = v[f.first] - own * impulse[0];
    change[0] = (rub(without, own, a, c) - without) / own - impulse[0];
  } else {
    const Matrix3d& turn = axes.eigenvectors();
    const Vector3d& own = axes.eigenvalues();
    const Vector3d without =
        turn.transpose() * v.segment<3>(f.first) - own.cwiseProduct(turn.transpose() * impulse);
    change = turn * (rub(without, own, a, c) - without).cwiseQuotient(own) - impulse;
  }
  impulse += change;
  double moved = 0;
  for (int k = 0; k < f.dofs; ++k) {
    v += w.col(f.first + k) * change[k];
    moved = std::max(moved, std::abs(w(f.first + k, f.first + k) * change[k]));
  }
  return moved;
}

namespace {

double relax(const JointLimit& limit, double& impulse, const Eigen::MatrixXd& w, double dt,
             Eigen::VectorXd& v) {
  const auto d = limit.direction.head(limit.dofs);
  const double own = d.dot(w.block(limit.first, limit.first, limit.dofs, limit.dofs) * d);
  const double speed = d.dot(v.segment(limit.first, limit.dofs));
  const double allowed = (limit.gap_rad >= 0 ? limit.gap_rad : erp_of_overrun * limit.gap_rad) / dt;
  const double wanted = std::min(0.0, impulse + (allowed - speed) / own);
  const double change = wanted - impulse;
  impulse = wanted;
  for (int k = 0; k < limit.dofs; ++k) v += w.col(limit.first + k) * (d[k] * change);
  return std::abs(own * change);
}

}  // namespace

int JointRows::solve(const Eigen::MatrixXd& w, std::span<const JointLimit> limits, double dt,
                     Eigen::VectorXd& v) {
  for (std::size_t k = 0; k < frictions_.size(); ++k)
    if (const auto& f = frictions_[k]; f.dofs == 3)
      axes_[k].compute(w.block<3, 3>(f.first, f.first));
  for (std::size_t k = 0; k < frictions_.size(); ++k)
    for (int i = 0; i < frictions_[k].dofs; ++i)
      v += w.col(frictions_[k].first + i) * impulses_[k][i];
  limit_impulses_.assign(limits.size(), 0.0);
  for (int sweep = 1; sweep <= max_sweeps; ++sweep) {
    double moved = 0;
    for (std::size_t k = 0; k < frictions_.size(); ++k)
      moved = std::max(moved, relax(frictions_[k], impulses_[k], axes_[k], w, dt, v));
    for (std::size_t k = 0; k < limits.size(); ++k)
      moved = std::max(moved, sim::relax(limits[k], limit_impulses_[k], w, dt, v));
    if (moved < rest_rad_per_s) return sweep;
  }
  return max_sweeps;
}

}  // namespace sim

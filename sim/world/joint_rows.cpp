#include "sim/world/joint_rows.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace sim {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int max_sweeps = 200;
constexpr double rest_rad_per_s = 1e-13;  // a sweep that changes less is the last
constexpr double erp_of_overrun = 0.2;    // how much of an overrun limit is undone a step; chosen

/// v⁺ of one coordinate: (1 + w a) v⁺ + w c sgn v⁺ ∋ v.
double rub(double v, double w, double a, double c) {
  const double driven = std::abs(v) - w * c;
  return driven > 0 ? std::copysign(driven / (1 + w * a), v) : 0.0;
}

/// v⁺ of three: (I + (a + c/|v⁺|) W) v⁺ = v, or 0 where the impulse W⁻¹ v is within c.
Vector3d rub(const Vector3d& v, const Matrix3d& w, double a, double c) {
  if (c > 0 && (w.inverse() * v).norm() <= c) return Vector3d::Zero();
  double speed = v.norm();
  Vector3d after = v;
  for (int k = 0; k < 60 && speed > 0; ++k) {  // fixed point in |v⁺|, monotone from above
    after = (Matrix3d::Identity() + (a + c / speed) * w).inverse() * v;
    const double next = after.norm();
    if (std::abs(next - speed) <= 1e-14 * v.norm()) break;
    speed = next;
  }
  return after;
}

}  // namespace

JointRows::JointRows(std::vector<JointFriction> frictions, int coordinates)
    : frictions_(std::move(frictions)), impulses_(frictions_.size(), Vector3d::Zero()) {
  limit_impulses_.reserve(static_cast<std::size_t>(2 * coordinates));
}

double JointRows::relax(const JointFriction& f, Vector3d& impulse, const Eigen::MatrixXd& w,
                        double dt, Eigen::VectorXd& v) const {
  const double a = f.viscous_Nm_s_per_rad * dt, c = f.coulomb_Nm * dt;
  Vector3d change = Vector3d::Zero();
  if (f.dofs == 1) {
    const double own = w(f.first, f.first), without = v[f.first] - own * impulse[0];
    change[0] = (rub(without, own, a, c) - without) / own - impulse[0];
  } else {
    const Matrix3d own = w.block<3, 3>(f.first, f.first);
    const Vector3d without = v.segment<3>(f.first) - own * impulse;
    change = own.inverse() * (rub(without, own, a, c) - without) - impulse;
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
    for (int i = 0; i < frictions_[k].dofs; ++i)
      v += w.col(frictions_[k].first + i) * impulses_[k][i];
  limit_impulses_.assign(limits.size(), 0.0);
  for (int sweep = 1; sweep <= max_sweeps; ++sweep) {
    double moved = 0;
    for (std::size_t k = 0; k < frictions_.size(); ++k)
      moved = std::max(moved, relax(frictions_[k], impulses_[k], w, dt, v));
    for (std::size_t k = 0; k < limits.size(); ++k)
      moved = std::max(moved, sim::relax(limits[k], limit_impulses_[k], w, dt, v));
    if (moved < rest_rad_per_s) return sweep;
  }
  return max_sweeps;
}

}  // namespace sim

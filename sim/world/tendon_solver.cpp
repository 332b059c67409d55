#include "sim/world/tendon_solver.hpp"

namespace sim {

TendonSolver::TendonSolver(int tendons, int coordinates, double theta)
    : theta_(theta),
      shares_(static_cast<std::size_t>(tendons)),
      tension_N_(static_cast<std::size_t>(tendons), 0.0),
      system_(coordinates, coordinates),
      right_(coordinates),
      velocity_(coordinates),
      mobile_(coordinates),
      inertia_(coordinates),
      factor_(coordinates) {}

double TendonSolver::theta_of(const StretchedTendon& tendon, double mobility, double dt_s) const {
  if (theta_ > 0) return theta_;
  const double k = dt_s * dt_s * tendon.stiffness_N_per_m * mobility;
  return 0.5 + 0.5 * k / (4 + k);
}

bool TendonSolver::settle(const Eigen::MatrixXd& h, const Eigen::MatrixXd& rows,
                          const Eigen::VectorXd& momentum, double dt_s) {
  system_ = h;
  right_ = momentum;
  for (std::size_t k = 0; k < shares_.size(); ++k) {
    if (!shares_[k].pulls) continue;
    const auto row = rows.row(static_cast<Eigen::Index>(k));
    system_.noalias() += dt_s * shares_[k].gain * row.transpose() * row;
    right_.noalias() -= dt_s * shares_[k].start * row.transpose();
  }
  factor_.compute(system_);
  velocity_ = factor_.solve(right_);
  bool settled = true;
  for (std::size_t k = 0; k < shares_.size(); ++k) {
    Share& share = shares_[k];
    tension_N_[k] = 0;
    if (!share.pulls) continue;
    const double f =
        share.start + share.gain * rows.row(static_cast<Eigen::Index>(k)).dot(velocity_);
    share.pulls = f >= 0;
    settled = settled && share.pulls;
    tension_N_[k] = share.pulls ? f : 0;
  }
  return settled;
}

std::span<const double> TendonSolver::solve(const Eigen::MatrixXd& h, const Eigen::MatrixXd& rows,
                                            const Eigen::VectorXd& momentum,
                                            std::span<const StretchedTendon> tendons, double dt_s) {
  if (theta_ == 0) inertia_.compute(h);
  for (std::size_t k = 0; k < tendons.size(); ++k) {
    const StretchedTendon& t = tendons[k];
    Share& share = shares_[k];
    share.pulls = t.stretch_m + dt_s * std::max(0.0, t.rate_m_per_s) > 0;
    if (!share.pulls) continue;
    double mobility = 0;  // J W Jᵀ
    if (theta_ == 0) {
      mobile_ = rows.row(static_cast<Eigen::Index>(k)).transpose();
      inertia_.matrixL().solveInPlace(mobile_);
      mobility = mobile_.squaredNorm();
    }
    const double theta = theta_of(t, mobility, dt_s);
    const double c1 = (theta - 1) / 2, c2 = (3 * theta - 1) / 2;
    share.gain = t.stiffness_N_per_m * c2 * dt_s + t.damping_N_s_per_m;
    share.start = t.stiffness_N_per_m * (t.stretch_m + c1 * dt_s * t.rate_m_per_s) +
                  share.gain * t.winding_m_per_s;
  }
  while (!settle(h, rows, momentum, dt_s)) continue;  // each time at least one fewer
  return tension_N_;
}

}  // namespace sim

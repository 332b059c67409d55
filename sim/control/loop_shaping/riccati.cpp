#include "sim/control/loop_shaping/riccati.hpp"

#include <Eigen/LU>
#include <Eigen/QR>
#include <cmath>
#include <stdexcept>

namespace sim::loop_shaping {

using Eigen::Index;
using Eigen::MatrixXd;

namespace {

/// The matrix with the same eigenvectors and the eigenvalues' signs: S ← (c S + (c S)⁻¹)/2.
MatrixXd sign_of(MatrixXd s) {
  constexpr double tolerance = 1e-13;  // relative, chosen
  constexpr int max_steps = 100;       // chosen
  for (int k = 0; k < max_steps; ++k) {
    const Eigen::PartialPivLU<MatrixXd> lu(s);
    const double log_determinant = lu.matrixLU().diagonal().array().abs().log().sum();
    if (!std::isfinite(log_determinant)) break;  // an eigenvalue on the imaginary axis
    const double c = std::exp(-log_determinant / static_cast<double>(s.rows()));
    const MatrixXd next = 0.5 * (c * s + lu.inverse() / c);
    const double relative_change = (next - s).lpNorm<1>() / next.lpNorm<1>();
    s = next;
    if (!(relative_change > tolerance)) break;
  }
  return s;
}

}  // namespace

MatrixXd riccati(const MatrixXd& a, const MatrixXd& g, const MatrixXd& q) {
  constexpr double max_relative_residual = 1e-6;  // chosen
  const Index n = a.rows();
  MatrixXd hamiltonian(2 * n, 2 * n);
  hamiltonian << a, -g, -q, -a.transpose();
  MatrixXd s = sign_of(hamiltonian);
  s.diagonal().array() += 1;  // its kernel is the stable subspace, [1; X]
  const MatrixXd x = s.rightCols(n).colPivHouseholderQr().solve(-s.leftCols(n));
  const MatrixXd symmetric = 0.5 * (x + x.transpose());
  const MatrixXd residual =
      a.transpose() * symmetric + symmetric * a - symmetric * g * symmetric + q;
  const double scale = 1 + 2 * (a.transpose() * symmetric).norm() + q.norm();
  if (!(residual.norm() < max_relative_residual * scale))
    throw std::domain_error("the Riccati equation has no stabilising solution");
  return symmetric;
}

}  // namespace sim::loop_shaping

#pragma once
#include <Eigen/Core>

namespace sim::loop_shaping {

/// The stabilising solution X = Xᵀ ≥ 0 of the algebraic Riccati equation
///
///   Aᵀ X + X A − X G X + Q = 0,    A − G X stable,    G = Gᵀ ≥ 0,  Q = Qᵀ ≥ 0
///
/// from the sign of the Hamiltonian matrix (Roberts 1980; scaling by the determinant: Byers 1987).
/// Throws std::domain_error if there is none: an unstable mode is not stabilisable through G or not
/// detectable through Q.
Eigen::MatrixXd riccati(const Eigen::MatrixXd& a, const Eigen::MatrixXd& g,
                        const Eigen::MatrixXd& q);

}  // namespace sim::loop_shaping

#pragma once
#include <Eigen/Core>
#include <vector>

namespace sim::diagnosis {

/// Returns the standard errors of a least-squares fit of residuals z with Jacobian J: the larger of
/// √(s² Cₖₖ) and √Vₖₖ,
///
///   C = (JᵀJ)⁻¹,   s² = max(1, mean z²),   V = B/(B − p) C Σ_b g_b g_bᵀ C,   g_b = Σ_{i in b} z_i J_i
///
/// B: number of blocks of one second, p: number of parameters. V accounts for residuals that are
/// correlated within a second, or larger where the noise floor is low. Zeros in z are windows that
/// are not evaluated. The standard error is infinite if z does not depend on the parameter, or if
/// it cannot be separated from others.
/// Source: sandwich estimator, White 1980; with clusters, Liang and Zeger 1986.
std::vector<double> standard_errors(const Eigen::MatrixXd& j, const Eigen::VectorXd& z);

}  // namespace sim::diagnosis

#pragma once
#include <Eigen/Core>
#include <vector>

namespace sim::diagnosis {

/// Standard deviations of least squares of z: √Cₖₖ with C = (JᵀJ)⁻¹, times the rms of z where that is
/// above 1; or, where that is more, √Vₖₖ of
///
///   V = B/(B − p) C Σ_b g_b g_bᵀ C,   g_b = Σ z_i J_i over a second of windows, B such blocks, p parameters
///
/// for what is more than noise is alike for a while, and weighs more where the noise is small. Zeros in z are not judged. Infinite where
/// nothing changes with a parameter, or nothing that another would not change alike.
/// Source: sandwich, White 1980; of clusters, Liang and Zeger 1986.
std::vector<double> deviations(const Eigen::MatrixXd& j, const Eigen::VectorXd& z);

}  // namespace sim::diagnosis

#include "sim/gap/diagnosis/standard_errors.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/gap/residuals/stages.hpp"

namespace sim::diagnosis {
namespace {

/// (JᵀJ)⁻¹ by its eigenvectors. A diagonal entry is infinite if the residuals do not depend on the
/// parameter, or if other parameters have the same effect on them.
Eigen::MatrixXd covariance(const Eigen::MatrixXd& j) {
  constexpr double infinite = std::numeric_limits<double>::infinity(), rounding_error = 1e-9;
  const Eigen::VectorXd length = j.colwise().norm().transpose();
  const Eigen::VectorXd scale = (length.array() > 0).select(length.cwiseInverse(), 0.0);
  const Eigen::MatrixXd cosines = scale.asDiagonal() * (j.transpose() * j) * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(cosines);
  const Eigen::ArrayXd eigenvalues = solver.eigenvalues().array();
  const Eigen::VectorXd inverse = (eigenvalues > rounding_error).select(eigenvalues.inverse(), 0.0);
  const Eigen::MatrixXd& v = solver.eigenvectors();
  Eigen::MatrixXd c =
      scale.asDiagonal() * (v * inverse.asDiagonal() * v.transpose()) * scale.asDiagonal();
  for (Eigen::Index k = 0; k < j.cols(); ++k)
    if (length[k] == 0 ||
        (v.row(k).array().square() > rounding_error && (eigenvalues <= rounding_error).transpose())
            .any())
      c(k, k) = infinite;
  return c;
}

}  // namespace

std::vector<double> standard_errors(const Eigen::MatrixXd& j, const Eigen::VectorXd& z) {
  const auto windows = Eigen::Index(std::lround(1.0 / residuals::Windows{}.stride_s));
  const Eigen::MatrixXd c = covariance(j);
  Eigen::MatrixXd finite = c;
  for (Eigen::Index k = 0; k < c.rows(); ++k)
    if (std::isinf(c(k, k))) finite(k, k) = 0;
  double blocks = 0;
  Eigen::VectorXd sandwich = Eigen::VectorXd::Zero(c.rows());
  for (Eigen::Index first = 0; first < z.size(); first += windows) {
    const Eigen::Index count = std::min(windows, z.size() - first);
    if (z.segment(first, count).isZero(0)) continue;
    const Eigen::VectorXd slope = j.middleRows(first, count).transpose() * z.segment(first, count);
    sandwich += (finite * slope).cwiseAbs2();
    ++blocks;
  }
  sandwich *= blocks / std::max(1.0, blocks - double(j.cols()));
  const auto evaluated = double((z.array() != 0).count());
  const double mean_square = std::max(1.0, z.squaredNorm() / std::max(1.0, evaluated));
  std::vector<double> sigma;
  for (Eigen::Index k = 0; k < c.rows(); ++k)
    sigma.push_back(std::sqrt(std::max(mean_square * c(k, k), sandwich[k])));
  return sigma;
}

}  // namespace sim::diagnosis

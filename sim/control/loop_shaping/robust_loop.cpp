#include "sim/control/loop_shaping/robust_loop.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>
#include <stdexcept>

#include "sim/control/loop_shaping/riccati.hpp"

namespace sim::loop_shaping {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;

RobustLoop stabilised(const StateSpace& shaped, double gamma_factor) {
  if (!shaped.d.isZero() || !(gamma_factor > 1))
    throw std::invalid_argument(
        "the plant must have no direct feed-through, and gamma_factor must be above 1");
  const auto& [a, b, c, d] = shaped;
  const MatrixXd x = riccati(a, b * b.transpose(), c.transpose() * c);
  const MatrixXd z = riccati(a.transpose(), c.transpose() * c, b * b.transpose());
  const MatrixXd xz = x * z;
  const double min_gamma =
      std::sqrt(1 + Eigen::EigenSolver<MatrixXd>(xz, false).eigenvalues().real().maxCoeff());
  const double gamma = gamma_factor * min_gamma, square = gamma * gamma;
  const Index n = a.rows();
  const MatrixXd l = (1 - square) * MatrixXd::Identity(n, n) + xz;
  const MatrixXd gain = square * l.transpose().partialPivLu().solve(z * c.transpose());
  // The formulas are for u = K y; for u = K (r − y) the sign changes.
  return {{a - b * b.transpose() * x + gain * c, gain, -b.transpose() * x,
           MatrixXd::Zero(shaped.inputs(), shaped.outputs())},
          1 / gamma,
          1 / min_gamma};
}

double margin_of(const StateSpace& plant, const StateSpace& controller, double low_rad_per_s,
                 double high_rad_per_s, int count) {
  double worst = 0;
  for (int k = 0; k < count; ++k) {
    const double w = low_rad_per_s * std::pow(high_rad_per_s / low_rad_per_s, k / (count - 1.0));
    const MatrixXcd g = response(plant, w), h = response(controller, w);
    const Index m = g.rows(), n = g.cols();
    MatrixXcd right(m, m + n), left(n + m, m);
    right << MatrixXcd::Identity(m, m), g;
    left << h, MatrixXcd::Identity(m, m);
    const MatrixXcd return_difference = MatrixXcd::Identity(m, m) + g * h;
    const MatrixXcd closed_loop = left * return_difference.partialPivLu().solve(right);
    worst = std::max(worst, Eigen::JacobiSVD<MatrixXcd>(closed_loop).singularValues()[0]);
  }
  return 1 / worst;
}

}  // namespace sim::loop_shaping

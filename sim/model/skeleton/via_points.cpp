#include "sim/model/skeleton/via_points.hpp"

#include <Eigen/SparseCholesky>
#include <cmath>

namespace sim {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// Matrix from (Δ, V₀, A₀, V₁, A₁) to c₁ … c₅.
const Eigen::Matrix<double, 5, 5>& quintic_of_ends() {
  static const Eigen::Matrix<double, 5, 5> rows = (Eigen::Matrix<double, 5, 5>() <<  //
                                                       0,
                                                   1, 0, 0, 0,             //
                                                   0, 0, 0.5, 0, 0,        //
                                                   10, -6, -1.5, -4, 0.5,  //
                                                   -15, 8, 1.5, 7, -1,     //
                                                   6, -3, -0.5, -3, 0.5)
                                                      .finished();
  return rows;
}

/// The matrix G in ∫ x‴² ds = zᵀ G z, z = (Δ, V₀, A₀, V₁, A₁).
Eigen::Matrix<double, 5, 5> jerk_cost() {
  // x‴ = 6 c₃ + 24 c₄ s + 60 c₅ s², and ∫ sⁱ sʲ ds = 1/(i + j + 1)
  const Eigen::Matrix<double, 3, 5> jerk =
      Eigen::Vector3d(6, 24, 60).asDiagonal() * quintic_of_ends().bottomRows<3>();
  Eigen::Matrix3d hilbert;
  hilbert << 1, 1.0 / 2, 1.0 / 3, 1.0 / 2, 1.0 / 3, 1.0 / 4, 1.0 / 3, 1.0 / 4, 1.0 / 5;
  return jerk.transpose() * hilbert * jerk;
}

/// The normal equations in v and a of all points. At points at rest, v and a are fixed at 0.
struct NormalEquations {
  std::vector<Eigen::Triplet<double>> entries;
  MatrixXd right_side;
  const std::vector<bool>& rests;

  bool is_at_rest(Index row) const { return rests[static_cast<std::size_t>(row / 2)]; }
  void add_segment(Index k, double T, const Eigen::RowVectorXd& delta) {
    static const auto cost = jerk_cost();
    const Eigen::Vector4d scale(T, T * T, T, T * T);
    const double weight = std::pow(T, -5);
    for (Index i = 0; i < 4; ++i) {
      if (is_at_rest(2 * k + i)) continue;
      right_side.row(2 * k + i) -= weight * scale[i] * cost(1 + i, 0) * delta;
      for (Index j = 0; j < 4; ++j)
        if (!is_at_rest(2 * k + j))
          entries.emplace_back(2 * k + i, 2 * k + j,
                               weight * scale[i] * cost(1 + i, 1 + j) * scale[j]);
    }
  }
};

}  // namespace

Quintic Quintic::between(double delta, double v0, double a0, double v1, double a1) {
  Eigen::Matrix<double, 5, 1> ends;
  ends << delta, v0, a0, v1, a1;
  return {quintic_of_ends() * ends};
}

QuinticSegment QuinticSegment::between(const Vec3& delta, const Vec3& v0, const Vec3& a0,
                                       const Vec3& v1, const Vec3& a1) {
  QuinticSegment all;
  for (Index d = 0; d < 3; ++d) {
    const Quintic one = Quintic::between(delta[d], v0[d], a0[d], v1[d], a1[d]);
    for (Index n = 0; n < 5; ++n) all.c[std::size_t(n)][std::size_t(d)] = one.c[n];
  }
  return all;
}

/// Evaluates the polynomial by Horner's method.
QuinticSegment::Place QuinticSegment::at(double s) const {
  Place p{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  const auto horner_step = [&](const Vec3& factor) {
    p.rate_of_rate = s * p.rate_of_rate + 2 * p.rate;
    p.rate = s * p.rate + p.u;
    p.u = s * p.u + factor;
  };
  for (std::size_t n = 5; n-- > 0;) horner_step(vec(c[n]));
  horner_step(Vec3::Zero());
  return p;
}

ViaMotions minimum_jerk_through(const std::vector<double>& times_s, const MatrixXd& deltas,
                                std::vector<bool> rests) {
  const Index points = deltas.rows() + 1;
  rests.front() = rests.back() = true;
  NormalEquations equations{{}, MatrixXd::Zero(2 * points, deltas.cols()), rests};
  for (Index k = 0; k + 1 < points; ++k) {
    const auto at = static_cast<std::size_t>(k);
    equations.add_segment(k, times_s[at + 1] - times_s[at], deltas.row(k));
  }
  for (Index row = 0; row < 2 * points; ++row)
    if (equations.is_at_rest(row)) equations.entries.emplace_back(row, row, 1);
  Eigen::SparseMatrix<double> matrix(2 * points, 2 * points);
  matrix.setFromTriplets(equations.entries.begin(), equations.entries.end());
  const MatrixXd solution =
      Eigen::SimplicialLDLT<decltype(matrix)>(matrix).solve(equations.right_side);
  ViaMotions motions{MatrixXd(points, deltas.cols()), MatrixXd(points, deltas.cols())};
  for (Index k = 0; k < points; ++k)
    motions.velocity.row(k) = solution.row(2 * k),
    motions.acceleration.row(k) = solution.row(2 * k + 1);
  return motions;
}

}  // namespace sim

#include "sim/learning/experience/base.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace sim::experience {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double per_drive = 4;        ///< neighbours for each drive; chosen
constexpr double prior_weight = 0.02;  ///< λ, as a share of the neighbours' own scatter; chosen

struct Weighed {
  const Experience* one = nullptr;
  double weight = 1;
};

struct Moments {
  Vector3d place_m = Vector3d::Zero();
  VectorXd scales_Vs;
  MatrixXd squares, mixed;  ///< Σ w Δs Δsᵀ, Σ w ΔX Δsᵀ
  double scatter_m2 = 0;    ///< Σ w |ΔX|² / Σ w
};

Moments moments_of(const std::vector<Weighed>& list, Index drives) {
  Moments m{.scales_Vs = VectorXd::Zero(drives),
            .squares = MatrixXd::Zero(drives, drives),
            .mixed = MatrixXd::Zero(3, drives)};
  double sum = 0;
  for (const auto& [one, w] : list)
    m.place_m += w * one->end_m, m.scales_Vs += w * one->scales_Vs, sum += w;
  if (sum == 0) return m;
  m.place_m /= sum, m.scales_Vs /= sum;
  for (const auto& [one, w] : list) {
    const VectorXd ds = one->scales_Vs - m.scales_Vs;
    const Vector3d dx = one->end_m - m.place_m;
    m.squares += w / sum * ds * ds.transpose(), m.mixed += w / sum * dx * ds.transpose();
    m.scatter_m2 += w / sum * dx.squaredNorm();
  }
  return m;
}

/// Ridge regression towards a prior: argmin Σ w |ΔX − H Δs|² + λ |H − prior|².
MatrixXd slope(const Moments& m, const MatrixXd& prior) {
  const Index n = m.squares.rows();
  const double lambda = std::max(1e-12, prior_weight * m.squares.trace() / static_cast<double>(n));
  const MatrixXd left = m.squares + lambda * MatrixXd::Identity(n, n);
  return left.ldlt().solve((m.mixed + lambda * prior).transpose()).transpose();
}

std::vector<Weighed> all_of(const std::vector<Experience>& experiences, int start) {
  std::vector<Weighed> list;
  for (const Experience& one : experiences)
    if (one.start == start) list.push_back({&one, 1});
  return list;
}

/// Conversion of scales to metres, in m/(V s), for the distance between two experiences.
double metres_per_scale(const Moments& m) {
  const double spread = m.squares.trace();
  return spread > 0 ? std::sqrt(m.scatter_m2 / spread) : 0;
}

}  // namespace

struct Base::Line {
  Vector3d place_m = Vector3d::Zero();
  VectorXd scales_Vs;
  MatrixXd influence;
};

std::size_t Base::count(int start) const {
  return static_cast<std::size_t>(
      std::ranges::count_if(all_, [&](const Experience& one) { return one.start == start; }));
}

MatrixXd Base::influence(int start) const {
  return slope(moments_of(all_of(all_, start), drives_), MatrixXd::Zero(3, drives_));
}

VectorXd Base::freedom(int start) const {
  return moments_of(all_of(all_, start), drives_).squares.diagonal();
}

Base::Line Base::line_near(int start, const Vector3d& place_m) const {
  std::vector<Weighed> list = all_of(all_, start);
  if (list.empty()) return {Vector3d::Zero(), VectorXd::Zero(drives_), MatrixXd::Zero(3, drives_)};
  const Moments whole = moments_of(list, drives_);
  const double metres = metres_per_scale(whole);
  const Experience& nearest = *std::ranges::min_element(list, {}, [&](const Weighed& w) {
                                 return (w.one->end_m - place_m).squaredNorm();
                               })->one;
  for (auto& [one, distance] : list)
    distance = (one->end_m - place_m).squaredNorm() +
               metres * metres * (one->scales_Vs - nearest.scales_Vs).squaredNorm();
  std::ranges::sort(list, {}, &Weighed::weight);
  list.resize(std::min(list.size(), static_cast<std::size_t>(per_drive * double(drives_))));
  const double farthest = 1.01 * list.back().weight;  // tricube (Cleveland 1979)
  for (auto& [one, weight] : list)
    weight = farthest > 0 ? std::pow(1 - std::pow(weight / farthest, 1.5), 3) : 1;
  const Moments near = moments_of(list, drives_);
  return {near.place_m, near.scales_Vs, slope(near, slope(whole, MatrixXd::Zero(3, drives_)))};
}

MatrixXd Base::influence(int start, const Vector3d& place_m) const {
  return line_near(start, place_m).influence;
}

VectorXd Base::inverse(int start, const Vector3d& target_m) const {
  const Line line = line_near(start, target_m);
  return line.scales_Vs +
         weighted_inverse(line.influence, freedom(start)) * (target_m - line.place_m);
}

MatrixXd weighted_inverse(const MatrixXd& influence, const VectorXd& freedom) {
  const MatrixXd weighed = freedom.asDiagonal() * influence.transpose();
  Eigen::Matrix3d square = influence * weighed;
  square.diagonal().array() += std::max(1e-12, 1e-6 * square.diagonal().maxCoeff());
  return weighed * square.ldlt().solve(Eigen::Matrix3d::Identity());
}

}  // namespace sim::experience

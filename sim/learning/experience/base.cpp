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

constexpr double neighbours_per_drive = 4;  ///< neighbours for each drive; chosen
constexpr double prior_weight = 0.02;  ///< λ, as a fraction of the neighbours' scatter; chosen

struct WeightedExperience {
  const Experience* experience = nullptr;
  double weight = 1;
};

struct Moments {
  Vector3d place_m = Vector3d::Zero();
  VectorXd scales_Vs;
  MatrixXd squares, mixed;  ///< Σ w Δs Δsᵀ, Σ w ΔX Δsᵀ
  double scatter_m2 = 0;    ///< Σ w |ΔX|² / Σ w
};

Moments moments_of(const std::vector<WeightedExperience>& list, Index drives) {
  Moments m{.scales_Vs = VectorXd::Zero(drives),
            .squares = MatrixXd::Zero(drives, drives),
            .mixed = MatrixXd::Zero(3, drives)};
  double sum = 0;
  for (const auto& [experience, w] : list)
    m.place_m += w * experience->end_m, m.scales_Vs += w * experience->scales_Vs, sum += w;
  if (sum == 0) return m;
  m.place_m /= sum, m.scales_Vs /= sum;
  for (const auto& [experience, w] : list) {
    const VectorXd ds = experience->scales_Vs - m.scales_Vs;
    const Vector3d dx = experience->end_m - m.place_m;
    m.squares += w / sum * ds * ds.transpose(), m.mixed += w / sum * dx * ds.transpose();
    m.scatter_m2 += w / sum * dx.squaredNorm();
  }
  return m;
}

/// Ridge regression towards a prior: argmin Σ w |ΔX − H Δs|² + λ |H − prior|².
MatrixXd slope(const Moments& m, const MatrixXd& prior) {
  const Index n = m.squares.rows();
  const double lambda = std::max(1e-12, prior_weight * m.squares.trace() / static_cast<double>(n));
  const MatrixXd regularized = m.squares + lambda * MatrixXd::Identity(n, n);
  return regularized.ldlt().solve((m.mixed + lambda * prior).transpose()).transpose();
}

std::vector<WeightedExperience> all_of(const std::vector<Experience>& experiences, int start) {
  std::vector<WeightedExperience> list;
  for (const Experience& experience : experiences)
    if (experience.start == start) list.push_back({&experience, 1});
  return list;
}

/// Conversion of scales to metres, in m/(V s), for the distance between two experiences.
double metres_per_scale(const Moments& m) {
  const double spread = m.squares.trace();
  return spread > 0 ? std::sqrt(m.scatter_m2 / spread) : 0;
}

}  // namespace

struct Base::LocalModel {
  Vector3d place_m = Vector3d::Zero();
  VectorXd scales_Vs;
  MatrixXd influence;
};

std::size_t Base::count(int start) const {
  return static_cast<std::size_t>(std::ranges::count_if(
      all_, [&](const Experience& experience) { return experience.start == start; }));
}

MatrixXd Base::influence(int start) const {
  return slope(moments_of(all_of(all_, start), drives_), MatrixXd::Zero(3, drives_));
}

VectorXd Base::freedom(int start) const {
  return moments_of(all_of(all_, start), drives_).squares.diagonal();
}

Base::LocalModel Base::local_model(int start, const Vector3d& place_m) const {
  std::vector<WeightedExperience> list = all_of(all_, start);
  if (list.empty()) return {Vector3d::Zero(), VectorXd::Zero(drives_), MatrixXd::Zero(3, drives_)};
  const Moments all_moments = moments_of(list, drives_);
  const double metres_per_Vs = metres_per_scale(all_moments);
  const Experience& nearest = *std::ranges::min_element(list, {}, [&](const WeightedExperience& w) {
                                 return (w.experience->end_m - place_m).squaredNorm();
                               })->experience;
  for (auto& [experience, distance] : list)
    distance =
        (experience->end_m - place_m).squaredNorm() +
        metres_per_Vs * metres_per_Vs * (experience->scales_Vs - nearest.scales_Vs).squaredNorm();
  std::ranges::sort(list, {}, &WeightedExperience::weight);
  list.resize(
      std::min(list.size(), static_cast<std::size_t>(neighbours_per_drive * double(drives_))));
  const double bandwidth = 1.01 * list.back().weight;  // tricube (Cleveland 1979)
  for (auto& [experience, weight] : list)
    weight = bandwidth > 0 ? std::pow(1 - std::pow(weight / bandwidth, 1.5), 3) : 1;
  const Moments near_moments = moments_of(list, drives_);
  return {near_moments.place_m, near_moments.scales_Vs,
          slope(near_moments, slope(all_moments, MatrixXd::Zero(3, drives_)))};
}

MatrixXd Base::influence(int start, const Vector3d& place_m) const {
  return local_model(start, place_m).influence;
}

VectorXd Base::inverse(int start, const Vector3d& target_m) const {
  const LocalModel model = local_model(start, target_m);
  return model.scales_Vs +
         weighted_inverse(model.influence, freedom(start)) * (target_m - model.place_m);
}

MatrixXd weighted_inverse(const MatrixXd& influence, const VectorXd& freedom) {
  const MatrixXd freedom_weighted = freedom.asDiagonal() * influence.transpose();
  Eigen::Matrix3d square = influence * freedom_weighted;
  square.diagonal().array() += std::max(1e-12, 1e-6 * square.diagonal().maxCoeff());
  return freedom_weighted * square.ldlt().solve(Eigen::Matrix3d::Identity());
}

}  // namespace sim::experience

#pragma once
#include <Eigen/Core>
#include <vector>

/// What was experienced, and what can be told from it (paper, 5.6).
///
/// Forward, near a stored experience, by the neighbours i it has in place and in scales:
///
///   X = X̄ + H (s − s̄),   H = argmin Σ w_i |X_i − X̄ − H (s_i − s̄)|² + λ |H − H_all|²
///
/// H, m/(V s), is the influence of each drive on the hand; H_all the same of the whole base. Inverse:
///
///   s = s̄ + W⁻¹Hᵀ (H W⁻¹Hᵀ)⁻¹ (X_d − X̄)
///
/// W weighs drives by how little the base has scaled them. Neighbours are near in s as well, because
/// many scales lead a redundant arm to one place, and what lies between two of them leads elsewhere.
namespace sim::experience {

struct Experience {
  int start = 0;              ///< which of the starting postures
  Eigen::VectorXd scales_Vs;  ///< by drive
  Eigen::Vector3d end_m;      ///< of the hand, at rest, in the world
};

class Base {
 public:
  Base() = default;
  Base(Eigen::Index drives, std::vector<Experience> experiences)
      : drives_(drives), all_(std::move(experiences)) {}

  void add(Experience experience) { all_.push_back(std::move(experience)); }
  const std::vector<Experience>& all() const { return all_; }
  std::size_t count(int start) const;

  /// H, about the stored experience that is nearest to a place.
  Eigen::MatrixXd influence(int start, const Eigen::Vector3d& place_m) const;
  /// H_all.
  Eigen::MatrixXd influence(int start) const;
  /// W⁻¹, V² s².
  Eigen::VectorXd freedom(int start) const;
  /// Scales that lead from a start to a place. Zero where nothing is known.
  Eigen::VectorXd inverse(int start, const Eigen::Vector3d& target_m) const;

 private:
  struct Line;
  Line line_about(int start, const Eigen::Vector3d& place_m) const;

  Eigen::Index drives_ = 0;
  std::vector<Experience> all_;
};

/// W⁻¹Hᵀ (H W⁻¹Hᵀ + ε)⁻¹: drives × 3, V s/m; ε a millionth of the largest, lest none is free.
Eigen::MatrixXd weighted_inverse(const Eigen::MatrixXd& influence, const Eigen::VectorXd& freedom);

}  // namespace sim::experience

#pragma once
#include <Eigen/Core>
#include <vector>

/// The stored experiences, and the forward and inverse models fitted to them (paper, 5.6).
///
/// Forward model near a stored experience, from its neighbours i in place and in scales:
///
///   X = X̄ + H (s − s̄),   H = argmin Σ w_i |X_i − X̄ − H (s_i − s̄)|² + λ |H − H_all|²
///
/// H, m/(V s), is the influence of each drive on the hand; H_all is that of the whole base. Inverse
/// model:
///
///   s = s̄ + W⁻¹Hᵀ (H W⁻¹Hᵀ)⁻¹ (X_d − X̄)
///
/// W⁻¹ is the variance of the scales in the base, by drive. Neighbours must also be near in s. A
/// redundant arm reaches one place with many scales, and the average of two of them leads to
/// another place.
namespace sim::experience {

struct Experience {
  int start = 0;              ///< index of the starting posture
  Eigen::VectorXd scales_Vs;  ///< by drive
  Eigen::Vector3d end_m;      ///< position of the hand at rest, in the world
};

class Base {
 public:
  Base() = default;
  Base(Eigen::Index drives, std::vector<Experience> experiences)
      : drives_(drives), all_(std::move(experiences)) {}

  void add(Experience experience) { all_.push_back(std::move(experience)); }
  const std::vector<Experience>& all() const { return all_; }
  std::size_t count(int start) const;

  /// H near the stored experience that is nearest to a place.
  Eigen::MatrixXd influence(int start, const Eigen::Vector3d& place_m) const;
  /// H_all.
  Eigen::MatrixXd influence(int start) const;
  /// W⁻¹: variance of the scales by drive, V² s².
  Eigen::VectorXd freedom(int start) const;
  /// Scales that bring the hand from a start to a place. Zero if the base has no experience of that
  /// start.
  Eigen::VectorXd inverse(int start, const Eigen::Vector3d& target_m) const;

 private:
  struct LocalModel;
  LocalModel local_model(int start, const Eigen::Vector3d& place_m) const;

  Eigen::Index drives_ = 0;
  std::vector<Experience> all_;
};

/// W⁻¹Hᵀ (H W⁻¹Hᵀ + ε)⁻¹: drives × 3, in V s/m. ε is a millionth of the largest diagonal element,
/// so that the inverse exists.
Eigen::MatrixXd weighted_inverse(const Eigen::MatrixXd& influence, const Eigen::VectorXd& freedom);

}  // namespace sim::experience

#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/gap/residuals/stages.hpp"

namespace sim::estimation {

/// The explanations of all episodes by a robot, and of their first parts with added noise.
struct Explained {
  std::vector<residuals::Explanation> real, disturbed;
};

/// The windows of one stage of one episode in the vector z.
struct Block {
  std::size_t stage;
  Eigen::Index first, count;
};

/// The stage residuals of all episodes in units of their noise, z = r/σ, as one vector. z is 0 at
/// windows that cannot be judged with the nominal robot. If a window cannot be judged with another
/// robot, z is the nominal residual.
///
///   σ² = ⟨(r(y + n) − r(y))²⟩      y: signals, n: noise of the sensors' data sheets
///
/// σ is the noise floor of the evaluated robot, not of the nominal one. With the nominal floor, a
/// constant that multiplies a noisy signal is estimated too small (errors in variables), and a
/// constant that scales an equation down lowers its residual. The ratio to the nominal floor is one
/// number for each stage, computed on the first part of all episodes.
class ResidualVector {
 public:
  /// `nominal` and `episodes` must outlive this object.
  ResidualVector(const erp::Robot& nominal, std::span<const residuals::Episode> episodes,
                 std::uint64_t seed, int threads);

  Explained explain(const erp::Robot& robot, int threads) const;
  /// For a robot that differs from that of `base` only in the parts of `reach`.
  Explained explain(const erp::Robot& robot, const Explained& base,
                    const residuals::Reach& reach) const;
  Eigen::VectorXd z(const Explained& explained) const;
  /// Noise floor / nominal noise floor of each stage; 1 if the nominal floor is 0.
  std::vector<double> floor_ratio(const Explained& explained) const;

  std::span<const Block> blocks() const { return blocks_; }
  /// Effective number of independent windows of each stage, Σ n/(1 + 2 Σ ρ_l).
  std::span<const double> independent() const { return independent_; }
  std::size_t stages() const { return stages_; }
  std::span<const residuals::Episode> episodes() const { return episodes_; }
  /// The nominal robot's explanation of the first episode; its residuals name the stages.
  const residuals::Explanation& first() const { return nominal_.front(); }

 private:
  std::vector<double> floors(const Explained& explained) const;
  void count_independent(const Explained& nominal);
  void cut_disturbed(const erp::Robot& robot, const Explained& nominal);

  std::span<const residuals::Episode> episodes_;
  std::vector<residuals::Episode> disturbed_;
  std::vector<residuals::Explanation> nominal_;
  std::vector<Block> blocks_;
  /// Of the nominal robot: noise floors of whole episodes, one per block, and of the first parts,
  /// one per stage.
  std::vector<double> floors_, first_floors_;
  std::vector<double> independent_;  ///< one per stage
  std::size_t stages_ = 0;
  Eigen::Index size_ = 0;
};

/// Number of values of a series per independent value, 1 + 2 Σ ρ_l. Values that are not judged are
/// 0.
/// Source: effective sample size, Geyer 1992.
double correlation_length(std::span<const double> series);

/// The change of z by a tiny step of an unknown, without windows that jump. A window that starts or
/// stops to be judged changes by more than its noise, even for the smallest step, and would
/// outweigh all others in a derivative.
Eigen::VectorXd tiny_change(const Eigen::VectorXd& after, const Eigen::VectorXd& before);

}  // namespace sim::estimation

#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/gap/residuals/stages.hpp"

namespace sim::estimation {

/// What a robot makes of every episode, and of the first part of each with other noise.
struct Explained {
  std::vector<residuals::Explanation> real, disturbed;
};

/// One stage of one episode within the vector of all z.
struct Block {
  std::size_t stage;
  Eigen::Index first, count;
};

/// The stage residuals of all episodes in units of their noise, z = r/σ, as one vector; 0 where the
/// nominal robot cannot judge. Where another robot cannot, the nominal residual stays.
///
/// σ is the noise floor of the robot at hand, not of the nominal one: else a constant that multiplies a
/// noisy signal comes out too small (errors in variables), and one that scales an equation down would
/// scale its error down (σ² = ⟨(r(y + n) − r(y))²⟩, n: noise of the sensors' data sheets). How much it is
/// above the nominal one is one number a stage, seen on the first part of all episodes.
class ResidualVector {
 public:
  /// `nominal` and `episodes` stay with the caller.
  ResidualVector(const erp::Robot& nominal, std::span<const residuals::Episode> episodes,
                 std::uint64_t seed, int threads);

  Explained explain(const erp::Robot& robot, int threads) const;
  /// Of a robot that differs from that of `base` by what `reach` states.
  Explained explain(const erp::Robot& robot, const Explained& base,
                    const residuals::Reach& reach) const;
  Eigen::VectorXd z(const Explained& explained) const;
  /// The noise floor of each stage in that of the nominal robot; 1 where that has none.
  std::vector<double> raised(const Explained& explained) const;

  std::span<const Block> blocks() const { return blocks_; }
  /// Of each stage: windows that the sensors' noise makes independent, Σ n/(1 + 2 Σ ρ_l).
  std::span<const double> independent() const { return independent_; }
  std::size_t stages() const { return stages_; }
  std::span<const residuals::Episode> episodes() const { return episodes_; }
  /// The nominal robot's; its residuals name the stages.
  const residuals::Explanation& first() const { return bare_.front(); }

 private:
  std::vector<double> floors(const Explained& explained) const;
  void count_independent(const Explained& nominal);
  void cut_disturbed(const erp::Robot& robot, const Explained& nominal);

  std::span<const residuals::Episode> episodes_;
  std::vector<residuals::Episode> disturbed_;
  std::vector<residuals::Explanation> bare_;
  std::vector<Block> blocks_;
  /// Of the nominal robot: noise floors of whole episodes, one a block, and of the first parts, one a stage.
  std::vector<double> floors_, first_floors_;
  std::vector<double> independent_;  ///< one a stage
  std::size_t stages_ = 0;
  Eigen::Index size_ = 0;
};

/// How many values of a series one independent one stands for, 1 + 2 Σ ρ_l; 0 are values not judged.
/// Source: effective sample size, Geyer 1992.
double correlated(std::span<const double> series);

/// What a tiny step of an unknown changes in z, without windows that jump: one that comes to be judged, or no longer
/// is, changes by more than its noise however small the step, and would outweigh all others in a derivative.
Eigen::VectorXd tiny_change(const Eigen::VectorXd& after, const Eigen::VectorXd& before);

}  // namespace sim::estimation

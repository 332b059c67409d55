#pragma once
#include "sim/gap/estimation/estimate.hpp"

namespace sim::estimation {

/// The remaining residual of each stage for a robot.
struct RemainingResidual {
  /// ⟨z²⟩ − 1; 0: noise only. Each |z| is limited to six standard deviations of its stage;
  /// otherwise a single event could outweigh all other windows.
  std::vector<double> excess;
  std::vector<double> floor_ratio;  ///< noise floor / noise floor of the nominal robot
};

RemainingResidual remaining_residual(const ResidualVector& residuals, const Explained& explained,
                                     const Eigen::VectorXd& z);
/// For a linear model: the noise floors are those of `base`.
RemainingResidual remaining_residual(const ResidualVector& residuals, const RemainingResidual& base,
                                     const Eigen::VectorXd& z);

/// −2 log likelihood of the remaining residual, if the variance of a stage is unknown but at least
/// that of its noise:
///
///   Σ_s n_s/4 [log(1 + excess_s) + 2 log max(1, floor_ratio_s/1.5)]     n_s: number of independent windows
///
/// The second term penalizes a law that filters a signal until no residual exceeds the noise. 1.5:
/// a mass that is 50 % larger raises the floor by this factor; chosen. 1/4: as in estimate.hpp.
double misfit(const RemainingResidual& remaining, const ResidualVector& residuals);
/// The term of one stage.
double misfit(const RemainingResidual& remaining, const ResidualVector& residuals,
              std::size_t stage);

}  // namespace sim::estimation

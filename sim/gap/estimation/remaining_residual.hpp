#pragma once
#include "sim/gap/estimation/estimate.hpp"

namespace sim::estimation {

/// The remaining residual of each stage for a robot.
struct RemainingResidual {
  /// ⟨z²⟩ − 1; 0: noise only. A window counts for at most six standard deviations of its stage, so that a single event
  /// does not look like a law.
  std::vector<double> excess;
  std::vector<double> raised;  ///< noise floor / that of the nominal robot
};

RemainingResidual remaining_residual(const ResidualVector& residuals, const Explained& explained,
                                     const Eigen::VectorXd& z);
/// The same for a linear model, which does not change the noise floors.
RemainingResidual remaining_residual(const ResidualVector& residuals, const RemainingResidual& base,
                                     const Eigen::VectorXd& z);

/// −2 log likelihood of the remaining residual, where the variance of a stage is unknown but at least that of its
/// noise:
///
///   Σ_s n_s/4 [log(1 + excess_s) + 2 log max(1, raised_s/1.5)]     n_s: independent windows
///
/// The second term: a law that filters a signal until nothing is visible above its noise explains nothing. 1.5: a mass
/// that is 50 % larger raises the floor by this factor; chosen. 1/4: as in estimate.hpp.
double misfit(const RemainingResidual& remaining, const ResidualVector& residuals);
/// Of one stage.
double misfit(const RemainingResidual& remaining, const ResidualVector& residuals,
              std::size_t stage);

}  // namespace sim::estimation

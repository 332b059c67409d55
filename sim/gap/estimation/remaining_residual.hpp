#pragma once
#include "sim/gap/estimation/estimate.hpp"

namespace sim::estimation {

/// What a robot leaves of recordings, one value a stage.
struct RemainingResidual {
  /// ⟨z²⟩ − 1; 0: nothing but noise. A window counts for no more than six deviations of its stage, so
  /// that one event does not pass for a law.
  std::vector<double> excess;
  std::vector<double> raised;  ///< noise floor, in that of the nominal robot
};

RemainingResidual remaining_residual(const ResidualVector& residuals, const Explained& explained,
                                     const Eigen::VectorXd& z);
/// The same by a linear model, which changes no noise floor.
RemainingResidual remaining_residual(const ResidualVector& residuals, const RemainingResidual& base,
                                     const Eigen::VectorXd& z);

/// −2 log of the likelihood of what is left where the variance of a stage is not known, but no less
/// than that of its noise:
///
///   Σ_s n_s/4 [log(1 + excess_s) + 2 log max(1, raised_s/1.5)]     n_s: independent windows
///
/// The second term: a law that filters a signal until nothing can be seen above its noise explains
/// nothing. 1.5: by as much a mass half as heavy again raises it; chosen. 1/4: as in estimate.hpp.
double misfit(const RemainingResidual& left, const ResidualVector& residuals);
/// Of one stage.
double misfit(const RemainingResidual& left, const ResidualVector& residuals, std::size_t stage);

}  // namespace sim::estimation

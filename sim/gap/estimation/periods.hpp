#pragma once
#include <cstddef>
#include <vector>

#include "sim/gap/estimation/estimate.hpp"
#include "sim/model/effects/library.hpp"

/// The number of periods per turn of an effect that is periodic in a shaft angle, from the residuals of the gearbox:
///
///   M = [⟨s cos nNθ⟩, ⟨s sin nNθ⟩]    under each window; s: sign of the speed, for a friction; N: for a cogging
///   score = bᵀ G⁻¹ b                  b = Mᵀ W (z + J δ),  G = Mᵀ W M − (Mᵀ W J) H⁻¹ (Jᵀ W M)
///
/// δ: the last step of the unknowns that are already estimated. The symbols are those of screen.hpp.
namespace sim::estimation {

/// Whether a parameter is a number of periods per turn.
bool counts_periods(const effects::Parameter& parameter);

/// The three best integers within the bounds of the parameter, the best first; empty if the effect has no such
/// parameter or the shaft was not recorded.
std::vector<double> periods_of(const effects::Placed& effect, const erp::Robot& robot,
                               const ResidualVector& residuals, const Estimate& base);

}  // namespace sim::estimation

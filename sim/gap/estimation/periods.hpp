#pragma once
#include <cstddef>
#include <vector>

#include "sim/gap/estimation/estimate.hpp"
#include "sim/model/effects/library.hpp"

/// The number n of periods per turn of an effect that is periodic in a shaft angle θ, from the
/// residuals z of the gearbox:
///
///   M = [⟨s cos nNθ⟩, ⟨s sin nNθ⟩]    under each window
///   score = bᵀ G⁻¹ b                  b = Mᵀ W (z + J δ),  G = Mᵀ W M − (Mᵀ W J) H⁻¹ (Jᵀ W M)
///
/// s: sign of the speed for friction, otherwise 1; N: gear ratio for cogging, otherwise 1; δ: last
/// step of the unknowns that are already estimated. Other symbols: screen.hpp.
namespace sim::estimation {

/// Whether a parameter is a number of periods per turn.
bool counts_periods(const effects::Parameter& parameter);

/// Returns the three integers with the highest scores within the bounds of the parameter, the best
/// first. Empty if the effect has no number of periods or the shaft was not recorded.
std::vector<double> periods_of(const effects::Placed& effect, const erp::Robot& robot,
                               const ResidualVector& residuals, const Estimate& base);

}  // namespace sim::estimation

#pragma once
#include <cstddef>
#include <vector>

#include "sim/model/effects/library.hpp"
#include "sim/gap/estimation/estimate.hpp"

/// How many periods a turn an effect has that repeats with the angle of a shaft, from the residuals of the
/// gearbox:
///
///   M = [⟨s cos nNθ⟩, ⟨s sin nNθ⟩]    under each window; s: way of turning, of a friction; N: of a cogging
///   score = bᵀ G⁻¹ b                  b = Mᵀ W (z + J δ),  G = Mᵀ W M − (Mᵀ W J) H⁻¹ (Jᵀ W M)
///
/// δ: the last step of what is estimated already. The symbols are those of screen.hpp.
namespace sim::estimation {

/// A parameter that counts periods a turn.
bool counts_periods(const effects::Parameter& parameter);

/// The three best whole numbers within the bounds of its parameter, the best first; empty if the effect has
/// no such parameter, or nothing is known of the shaft.
std::vector<double> periods_of(const effects::Placed& effect, const erp::Robot& robot,
                               const ResidualVector& residuals, const Estimate& base);

}  // namespace sim::estimation

#pragma once
#include <span>

#include "sim/gap/residuals/explanation.hpp"

namespace sim::residuals {

/// The residuals of an actuator's motor, gearbox and tendon at the windows around `rows`. A stage
/// whose signals are not available is omitted. Equations: stages.hpp.
std::vector<Residual> chain_residuals(const ChainTrace& chain, const erp::Actuator& actuator,
                                      const erp::MotorType& motor, const Episode& episode,
                                      const Bump& bump, std::span<const std::size_t> rows);

}  // namespace sim::residuals

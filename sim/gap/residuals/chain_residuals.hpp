#pragma once
#include <span>

#include "sim/gap/residuals/explanation.hpp"

namespace sim::residuals {

/// The residuals of an actuator's motor, gearbox and tendon, as far as its signals allow; equations in stages.hpp.
std::vector<Residual> chain_residuals(const ChainTrace& chain, const erp::Actuator& actuator,
                                      const erp::MotorType& motor, const Episode& episode,
                                      const Bump& bump, std::span<const std::size_t> rows);

}  // namespace sim::residuals

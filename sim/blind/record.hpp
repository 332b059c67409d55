#pragma once
#include "interfaces/recording/table.hpp"
#include "sim/actuator/excitation.hpp"
#include "sim/blind/case.hpp"

namespace sim::blind {

/// Runs the robot of a case under the real ECU firmware through an excitation, and returns what
/// its sensors and the bus let one see: the columns of a recording. Throws std::runtime_error when
/// the motion is not finite.
recording::Table record(const erp::Robot& nominal, const Case& blind, const Excitation& excitation,
                        std::uint64_t seed);

}  // namespace sim::blind

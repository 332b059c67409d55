#pragma once
#include <stdexcept>

#include "interfaces/recording/table.hpp"
#include "sim/control/excitation.hpp"
#include "sim/gap/blind/case.hpp"

namespace sim::blind {

/// Motion that runs away from what numbers hold: a robot that would have broken.
struct NotFinite : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Runs the robot of a case under the real ECU firmware through an excitation, and returns what
/// its sensors and the bus let one see: the columns of a recording. Throws NotFinite.
recording::Table record(const erp::Robot& nominal, const Case& blind, const Excitation& excitation,
                        std::uint64_t seed);

}  // namespace sim::blind

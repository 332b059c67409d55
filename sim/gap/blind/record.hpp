#pragma once
#include <stdexcept>

#include "interfaces/recording/table.hpp"
#include "sim/control/excitation.hpp"
#include "sim/gap/blind/case.hpp"

namespace sim::blind {

/// The motion diverged.
struct NotFinite : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Simulates the robot of a case with the ECU firmware and an excitation. `seed`: of noise, jitter
/// and loss. Returns the columns of a recording, as received over the bus. Throws NotFinite.
recording::Table record(const erp::Robot& nominal, const Case& blind, const Excitation& excitation,
                        std::uint64_t seed);

}  // namespace sim::blind

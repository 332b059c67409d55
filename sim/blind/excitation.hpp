#pragma once
#include <cstdint>
#include <vector>

#include "firmware/core/ecu.h"
#include "interfaces/robot/robot.hpp"

/// What the robot of a blind case is asked to do: as a person would who wants to know it.
namespace sim::blind {

struct Excitation {
  ecu_request request = ECU_REQUEST_LENGTH;
  double period_s = 0.002;
  /// By row and actuator: N, or the line's change of length in m.
  std::vector<std::vector<double>> reference;
};

/// One a recording, all different: slow between postures with dwells, tensions that swing and
/// come near slack, low and high co-contraction, fast. Robots of one joint get tensions too.
Excitation excitation(const erp::Robot& robot, int recording, double duration_s,
                      std::uint64_t seed);

}  // namespace sim::blind

#pragma once
#include "interfaces/robot/actuator.hpp"

namespace accuracy {

/// Of runs through all four quadrants, without load and with short-circuited terminals: the worst.
struct MotorAudit {
  double left_over = 0;     ///< energy, as a share of what was turned over
  double gear_gives_W = 0;  ///< 0: it never does
};
MotorAudit audit_motor(const erp::MotorType& type);

}  // namespace accuracy

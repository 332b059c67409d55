#pragma once
#include <cstdint>

#include "firmware/core/ecu.h"
#include "interfaces/robot/robot.hpp"
#include "interfaces/values.hpp"

/// Conversion between SI units and the counts of an ECU, for one actuator.
///
///   shaft = encoder · 2π / (counts per rev · N)        line = −r · shaft
///   current = counts · range / 2^(bits−1)              voltage = duty / 1023 · supply
///   tension = (counts − z) · range / (2^bits − 1 − z)
namespace sim {

struct EcuUnits {
  double radius_m, shaft_rad_per_count, current_A_per_count, tension_N_per_count, supply_V;
  int tension_zero_counts;  ///< z, the live zero

  EcuUnits(const erp::MotorType& motor, const erp::SensorType& sensors,
           const erp::Spindle& spindle);

  double shaft_rad(std::int32_t encoder_counts) const {
    return encoder_counts * shaft_rad_per_count;
  }
  /// Change of the line length since power-on; negative: wound up.
  double line_m(double shaft) const { return -radius_m * shaft; }
  double shaft_of_line_rad(double line) const { return -line / radius_m; }
  double tension_N(std::uint16_t counts) const {
    return (counts - tension_zero_counts) * tension_N_per_count;
  }
  double voltage_V(std::int16_t duty) const { return duty * supply_V / ECU_DUTY_MAX; }

  /// The ECU's request and set-point for a reference in V, m, A or N.
  static ecu_request request(erp::Mode mode);
  std::int32_t setpoint(erp::Mode mode, double reference) const;
  /// The inverse: mode and reference from the request and set-point that an ECU reports.
  static erp::Mode mode(std::uint8_t request);
  double reference(std::uint8_t request, std::int32_t setpoint) const;
};

}  // namespace sim

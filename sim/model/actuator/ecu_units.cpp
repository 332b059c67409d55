#include "sim/model/actuator/ecu_units.hpp"

#include <cmath>

#include "sim/model/actuator/sensors.hpp"

namespace sim {

EcuUnits::EcuUnits(const erp::MotorType& motor, const erp::SensorType& sensors,
                   const erp::Spindle& spindle)
    : radius_m(spindle.radius_m), supply_V(motor.supply_V) {
  const SensorScale scale(motor, sensors);
  shaft_rad_per_count = scale.shaft_rad_per_count;
  current_A_per_count = scale.current_A_per_count;
  tension_N_per_count = scale.tension_N_per_count;
  tension_zero_counts = scale.tension_zero_counts;
}

ecu_request EcuUnits::request(erp::Mode mode) {
  switch (mode) {
    case erp::Mode::voltage:
      return ECU_REQUEST_VOLTAGE;
    case erp::Mode::length:
      return ECU_REQUEST_LENGTH;
    case erp::Mode::current:
      return ECU_REQUEST_CURRENT;
    case erp::Mode::force:
      return ECU_REQUEST_FORCE;
    case erp::Mode::off:
      break;
  }
  return ECU_REQUEST_OFF;
}

std::int32_t EcuUnits::setpoint(erp::Mode mode, double reference) const {
  const double counts = mode == erp::Mode::length ? -reference / radius_m / shaft_rad_per_count
                                                  : 1000.0 * reference;  // mV, mA, mN
  return static_cast<std::int32_t>(std::lround(counts));
}

erp::Mode EcuUnits::mode(std::uint8_t request) {
  switch (request) {
    case ECU_REQUEST_VOLTAGE:
      return erp::Mode::voltage;
    case ECU_REQUEST_LENGTH:
      return erp::Mode::length;
    case ECU_REQUEST_CURRENT:
      return erp::Mode::current;
    case ECU_REQUEST_FORCE:
      return erp::Mode::force;
    default:
      return erp::Mode::off;
  }
}

double EcuUnits::reference(std::uint8_t request, std::int32_t setpoint) const {
  if (request == ECU_REQUEST_LENGTH) return line_m(shaft_rad(setpoint));
  return mode(request) == erp::Mode::off ? 0.0 : 0.001 * setpoint;
}

}  // namespace sim

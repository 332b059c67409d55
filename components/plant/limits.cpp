#include "components/plant/limits.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace plant {

Limits::Limits(const erp::Actuator& actuator, const erp::MotorType& motor,
               const erp::SensorType& sensors)
    : supply_V_(motor.supply_V),
      current_A_(motor.current_limit_A),
      tension_N_(actuator.max_tension_N) {
  if (tension_N_ > sensors.tension_range_N)
    throw std::invalid_argument(actuator.name + ": max_tension_N " + std::to_string(tension_N_) +
                                " exceeds the sensor's range of " +
                                std::to_string(sensors.tension_range_N) + " N");
}

static Checked check_range(double reference, double min, double max, std::string_view reason) {
  if (!std::isfinite(reference)) return {Verdict::refused, 0, "reference is not a number"};
  if (reference > 2 * max || reference < 2 * min)
    return {Verdict::refused, 0, "reference is far out of range"};
  const double limited = std::clamp(reference, min, max);
  if (limited == reference) return {Verdict::accepted, reference, {}};
  return {Verdict::limited, limited, reason};
}

Checked Limits::check(erp::Mode mode, double reference) const {
  switch (mode) {
    case erp::Mode::off:
      return {Verdict::accepted, 0, {}};
    case erp::Mode::voltage:
      return check_range(reference, -supply_V_, supply_V_, "limited to the supply voltage");
    case erp::Mode::length:
      return check_range(reference, -max_line_m, max_line_m, "limited to the line on the spindle");
    case erp::Mode::current:
      return check_range(reference, -current_A_, current_A_,
                         "limited to the motor's current limit");
    case erp::Mode::force:
      return check_range(reference, 0, tension_N_, "limited to max_tension_N");
  }
  return {Verdict::refused, 0, "unknown mode"};
}

}  // namespace plant

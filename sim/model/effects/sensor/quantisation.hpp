#pragma once
#include <cmath>

#include "sim/model/effects/sensor/sense.hpp"

namespace sim::effects {

/// The quantization step of a sensor is coarser than specified, for example because of stuck bits.
///
///   reading = q ⌊value/q⌉
///
/// Not invertible: `undo` returns the reading.
/// Source: Widrow, Kollár, Quantization Noise, 2008.
template <Sense kind>
struct SensorQuantisation {
  static constexpr Sense sense = kind;
  static constexpr About about{
      by_sensor<kind>("sensor_shaft_quantisation", "sensor_current_quantisation",
                      "sensor_tension_quantisation", "sensor_joint_quantisation"),
      Stage::sensor, seat_of<kind>, "slow motion"};

  double step = 0;  // q

  void visit(auto& v) {
    v(by_sensor<kind>("step_rad", "step_A", "step_N", "step_rad"), step,
      by_sensor<kind>(Bounds{0, 0.1}, Bounds{0, 1}, Bounds{0, 10}, Bounds{0, 0.1}));
  }
  double read(double value, const SensorSample&, Memory&) const {
    return step > 0 ? step * std::round(value / step) : value;
  }
  double undo(double reading, const SensorSample&, Memory&) const { return reading; }
};

}  // namespace sim::effects

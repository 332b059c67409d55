#pragma once
#include "sim/model/effects/sensor/sense.hpp"

namespace sim::effects {

/// A constant offset of a sensor.
///
///   reading = value + b
///
/// Source: JCGM 200:2012 (VIM), 4.20, instrumental bias.
template <Sense kind>
struct SensorOffset {
  static constexpr Sense sense = kind;
  static constexpr About about{by_sensor<kind>("sensor_shaft_offset", "sensor_current_offset",
                                               "sensor_tension_offset", "sensor_joint_offset"),
                               Stage::sensor, seat_of<kind>, "any motion"};

  double offset = 0;  // b

  void visit(auto& v) {
    v(by_sensor<kind>("offset_rad", "offset_A", "offset_N", "offset_rad"), offset,
      by_sensor<kind>(Bounds{-1, 1}, Bounds{-3, 3}, Bounds{-50, 50}, Bounds{-0.7, 0.7}));
  }
  double read(double value, const SensorSample&, Memory&) const { return value + offset; }
  double undo(double reading, const SensorSample&, Memory&) const { return reading - offset; }
};

}  // namespace sim::effects

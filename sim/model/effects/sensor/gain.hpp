#pragma once
#include "sim/model/effects/sensor/sense.hpp"

namespace sim::effects {

/// A gain error of a sensor.
///
///   reading = (1 + a) value
///
/// Source: JCGM 200:2012 (VIM), 4.12, sensitivity.
template <Sense kind>
struct SensorGain {
  static constexpr Sense sense = kind;
  static constexpr About about{by_sensor<kind>("sensor_shaft_gain", "sensor_current_gain",
                                               "sensor_tension_gain", "sensor_joint_gain"),
                               Stage::sensor, seat_of<kind>, "the whole range of the sensor"};

  double relative = 0;  // a

  void visit(auto& v) { v("relative", relative, Bounds{-0.6, 1}); }
  double read(double value, const SensorSample&, Memory&) const { return (1 + relative) * value; }
  double undo(double reading, const SensorSample&, Memory&) const {
    return reading / (1 + relative);
  }
};

}  // namespace sim::effects

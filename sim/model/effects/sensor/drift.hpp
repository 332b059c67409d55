#pragma once
#include "sim/model/effects/sensor/sense.hpp"

namespace sim::effects {

/// The zero of a sensor drifts at a constant rate.
///
///   reading = value + d t
///
/// Source: JCGM 200:2012 (VIM), 4.21, instrumental drift.
template <Sense kind>
struct SensorDrift {
  static constexpr Sense sense = kind;
  static constexpr About about{by_sensor<kind>("sensor_shaft_drift", "sensor_current_drift",
                                               "sensor_tension_drift", "sensor_joint_drift"),
                               Stage::sensor, seat_of<kind>, "long recordings"};

  double rate = 0;  // d

  void visit(auto& v) {
    v(by_sensor<kind>("rate_rad_per_s", "rate_A_per_s", "rate_N_per_s", "rate_rad_per_s"), rate,
      by_sensor<kind>(Bounds{-0.1, 0.1}, Bounds{-0.2, 0.2}, Bounds{-3, 3}, Bounds{-0.05, 0.05}));
  }
  double read(double value, const SensorSample& s, Memory&) const {
    return value + rate * s.time_s;
  }
  double undo(double reading, const SensorSample& s, Memory&) const {
    return reading - rate * s.time_s;
  }
};

}  // namespace sim::effects

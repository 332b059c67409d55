#pragma once
#include <cmath>

#include "sim/model/effects/sensor/sense.hpp"

namespace sim::effects {

/// First-order lag of a sensor's amplifier.
///
///   T d reading/dt = value − reading
///
/// Source: JCGM 200:2012 (VIM), 4.23, step response time; first order.
template <Sense kind>
struct SensorLowPass {
  static constexpr Sense sense = kind;
  static constexpr About about{by_sensor<kind>("sensor_shaft_low_pass", "sensor_current_low_pass",
                                               "sensor_tension_low_pass", "sensor_joint_low_pass"),
                               Stage::sensor, seat_of<kind>, "fast changes"};

  double time_constant_s = 0;  // T

  void visit(auto& v) { v("time_constant_s", time_constant_s, Bounds{0, 0.2}); }
  /// Exact for a value that changes linearly between two readings.
  double read(double value, const SensorSample& s, Memory& memory) const {
    double &reading = memory[0], &previous = memory[1], &initialized = memory[2];
    if (initialized == 0) reading = previous = value, initialized = 1;
    if (time_constant_s > 0 && s.dt_s > 0) {
      const double decay = std::exp(-s.dt_s / time_constant_s);
      const double lag_fraction = time_constant_s * (1 - decay) / s.dt_s;
      reading = decay * reading + value - decay * previous - lag_fraction * (value - previous);
    } else {
      reading = value;
    }
    previous = value;
    return reading;
  }
  double undo(double reading, const SensorSample& s, Memory&) const {
    return reading + time_constant_s * s.reading_rate;
  }
  double averaged(const SensorSample& s) const {
    return -std::expm1(-2 * time_constant_s / s.dt_s);
  }
};

}  // namespace sim::effects

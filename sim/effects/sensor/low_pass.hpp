#pragma once
#include <cmath>

#include "sim/effects/sensor/sense.hpp"

namespace sim::effects {

/// A sensor's amplifier is slow.
///
///   T d said/dt = value − said
///
/// Source: JCGM 200:2012 (VIM), 4.23, step response time; first order.
template <Sense kind>
struct SensorLowPass {
  static constexpr Sense sense = kind;
  static constexpr About about{word_of<kind>("sensor_shaft_low_pass", "sensor_current_low_pass",
                                             "sensor_tension_low_pass", "sensor_joint_low_pass"),
                               Stage::sensor, seat_of<kind>, "fast changes"};

  double time_constant_s = 0;  // T

  void visit(auto& v) { v("time_constant_s", time_constant_s, Bounds{0, 0.2}); }
  double read(double value, const SensorSample& s, Memory& memory) const {
    double &said = memory[0], &began = memory[1];
    said = value + (began != 0 ? kept(s) : 0) * (said - value);
    began = 1;
    return said;
  }
  double undo(double said, const SensorSample& s, Memory& memory) const {
    double &last = memory[0], &began = memory[1];
    const double stays = began != 0 ? kept(s) : 0;
    const double value = (said - stays * last) / (1 - stays);
    last = said, began = 1;
    return value;
  }

 private:
  double kept(const SensorSample& s) const {
    return time_constant_s > 0 ? std::exp(-s.dt_s / time_constant_s) : 0;
  }
};

}  // namespace sim::effects

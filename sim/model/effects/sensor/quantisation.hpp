#pragma once
#include <cmath>

#include "sim/model/effects/sensor/sense.hpp"

namespace sim::effects {

/// A sensor's steps are coarser than its data sheet says: bits that do not change.
///
///   said = q ⌊value/q⌉
///
/// What is lost cannot be undone.
/// Source: Widrow, Kollár, Quantization Noise, 2008.
template <Sense kind>
struct SensorQuantisation {
  static constexpr Sense sense = kind;
  static constexpr About about{
      word_of<kind>("sensor_shaft_quantisation", "sensor_current_quantisation",
                    "sensor_tension_quantisation", "sensor_joint_quantisation"),
      Stage::sensor, seat_of<kind>, "slow motion"};

  double step = 0;  // q

  void visit(auto& v) {
    v(word_of<kind>("step_rad", "step_A", "step_N", "step_rad"), step,
      word_of<kind>(Bounds{0, 0.1}, Bounds{0, 1}, Bounds{0, 10}, Bounds{0, 0.1}));
  }
  double read(double value, const SensorSample&, Memory&) const {
    return step > 0 ? step * std::round(value / step) : value;
  }
  double undo(double said, const SensorSample&, Memory&) const { return said; }
};

}  // namespace sim::effects

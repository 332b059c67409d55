#pragma once
#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// A constant delay of the measurements from the ECUs to the controllers. The ECUs' own loops are not
/// delayed.
///
///   t_received = t_measured + T
///
/// Source: Nilsson, Real-Time Control Systems with Delays, Lund 1998.
struct SensorDelay {
  static constexpr About about{"bus_sensor_delay", Stage::bus, Seat::robot,
                               "fast changes of the references"};

  double delay_s = 0;  // T

  void visit(auto& v) { v("delay_s", delay_s, Bounds{0, 0.1}); }
  double frame_delay_s(double) const { return delay_s; }
};

}  // namespace sim::effects

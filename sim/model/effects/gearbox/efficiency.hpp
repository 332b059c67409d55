#pragma once
#include <algorithm>

#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// The gear passes on a smaller or a larger share of the torque, driven and back-driven.
///
///   η' = min(1, (1 + a) η)
///
/// Source: paper, eq. 3; back-driven, a load counts η' times (sim/model/actuator/motor.hpp).
struct GearboxEfficiency {
  static constexpr About about{"gearbox_efficiency", Stage::gearbox, Seat::actuator,
                               "motion both ways under several loads"};

  double relative = 0;  // a

  void visit(auto& v) { v("relative", relative, Bounds{-0.9, 1}); }
  void change_motor(auto& motor) const {
    motor.gear_efficiency = std::min(1.0, (1 + relative) * motor.gear_efficiency);
  }
};

}  // namespace sim::effects

#pragma once
#include <algorithm>

#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// Change of the gear's efficiency, driven and back-driven.
///
///   η' = min(1, (1 + a) η)
///
/// Source: paper, eq. 3; a back-driving load acts with the factor η' (sim/model/actuator/motor.hpp).
struct GearboxEfficiency {
  static constexpr About about{"gearbox_efficiency", Stage::gearbox, Seat::actuator,
                               "motion in both directions under several loads"};

  double relative = 0;  // a

  void visit(auto& v) { v("relative", relative, Bounds{-0.9, 1}); }
  void change_motor(auto& motor) const {
    motor.gear_efficiency = std::min(1.0, (1 + relative) * motor.gear_efficiency);
  }
};

}  // namespace sim::effects

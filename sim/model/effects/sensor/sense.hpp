#pragma once
#include <array>

#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// Selects one of four values by the kind of sensor.
template <Sense sense>
constexpr auto by_sensor(const auto& shaft, const auto& current, const auto& tension,
                         const auto& joint) {
  if constexpr (sense == Sense::shaft) return shaft;
  else if constexpr (sense == Sense::current) return current;
  else if constexpr (sense == Sense::tension) return tension;
  else return joint;
}

template <Sense sense>
inline constexpr Seat seat_of = sense == Sense::joint ? Seat::joint : Seat::actuator;

}  // namespace sim::effects

#pragma once
#include <array>

#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// One of four words, by the kind of sensor.
template <Sense sense>
constexpr auto word_of(const auto& shaft, const auto& current, const auto& tension,
                       const auto& joint) {
  if constexpr (sense == Sense::shaft) return shaft;
  else if constexpr (sense == Sense::current) return current;
  else if constexpr (sense == Sense::tension) return tension;
  else return joint;
}

template <Sense sense>
inline constexpr Seat seat_of = sense == Sense::joint ? Seat::joint : Seat::actuator;

}  // namespace sim::effects

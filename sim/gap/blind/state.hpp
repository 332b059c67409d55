#pragma once
#include <cmath>

/// Indices of the plant's state.
namespace sim::blind {

namespace channel_state {
enum : std::size_t {
  current,
  shaft,
  speed,
  bristle,  // of motor and gearbox
  spindle,
  spindle_speed,  // after play or a compliant shaft
  slip,           // line lost by slip
  crept,          // stretch of the creep element
  inner,          // stretch of the spring in series with a compliant line
  slide1,
  slide2,
  slide3,
  line_bristle,
  heat,
  aged,           // ageing of stiction: 0 in motion, 1 after a long rest
  reading_shaft,  // after the low-pass
  reading_current,
  reading_tension,
  count
};
}
namespace joint_state {
enum : std::size_t {
  position,
  velocity = position + 4,
  bristle = velocity + 3,
  bearing = bristle + 3,
  reading,
  count
};
}

/// Travel that deflects a bristle fully. It is longer at high speed: the deflection takes at least
/// one step of the integrator.
inline double bristle_travel(double travel, double speed) {
  constexpr double min_duration_s = 1e-4;
  return std::fmax(travel, min_duration_s * std::abs(speed));
}

/// ṡ = (v − |v| s)/δ of a bristle with deflection s, speed v and travel δ.
inline double bristle_rate(double s, double speed, double travel) {
  return (speed - std::abs(speed) * s) / bristle_travel(travel, speed);
}

}  // namespace sim::blind

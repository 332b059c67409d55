#pragma once
#include <cmath>

/// Where things are in the plant's state.
namespace sim::blind {

namespace chain_state {
enum : std::size_t {
  current,
  shaft,
  speed,
  bristle,  // motor and gearbox
  spindle,
  spindle_speed,  // behind play or a soft shaft
  lost,
  flowed,
  inner,  // of the spring behind a line that stretches
  slide1,
  slide2,
  slide3,
  line_bristle,
  heat,
  aged,  // of stiction
  said_shaft,
  said_current,
  said_tension,
  count
};
}
namespace joint_state {
enum : std::size_t {
  position,
  velocity = position + 4,
  bristle = velocity + 3,
  bearing = bristle + 3,
  said,
  count
};
}

/// Motion after which a bristle is fully bent; at speed longer, that it takes a step of the integrator at least.
inline double bristle_reach(double reach, double speed) {
  constexpr double least_s = 1e-4;
  return std::fmax(reach, least_s * std::abs(speed));
}

/// ṡ of a bristle; `most`: what it may bend to.
inline double bristle_rate(double s, double speed, double reach, double most = 1) {
  return (speed - std::abs(speed) * s / most) / bristle_reach(reach, speed);
}

}  // namespace sim::blind

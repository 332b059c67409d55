#pragma once
#include <cmath>

/// Indices of the plant's state.
namespace sim::blind {

namespace chain_state {
enum : std::size_t {
  current,
  shaft,
  speed,
  bristle,  // motor and gearbox
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
  aged,           // ageing of stiction
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

/// Motion after which a bristle is fully deflected. Longer at high speed, so that it takes at least one step of the
/// integrator.
inline double bristle_reach(double reach, double speed) {
  constexpr double least_s = 1e-4;
  return std::fmax(reach, least_s * std::abs(speed));
}

/// ṡ of a bristle; `most`: its largest deflection.
inline double bristle_rate(double s, double speed, double reach, double most = 1) {
  return (speed - std::abs(speed) * s / most) / bristle_reach(reach, speed);
}

}  // namespace sim::blind

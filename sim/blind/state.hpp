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

/// ṡ of a bristle that is fully bent after `reach` of motion; `most`: what it may bend to.
inline double bristle_rate(double s, double speed, double reach, double most = 1) {
  return (speed - std::abs(speed) * s / most) / reach;
}

}  // namespace sim::blind

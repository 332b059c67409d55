#pragma once
#include <vector>

#include "sim/world/world.hpp"

namespace accuracy {

/// The mean of `periods` periods of a value of the world, from fall through 0 to fall through 0;
/// motors at 0 V. Between steps by interpolation.
double mean_period_s(sim::World& world, int periods, double dt_s, auto&& value) {
  const std::vector<double> off_V(world.actuators().size(), 0.0);
  double first_s = 0, last_s = 0, before = value();
  for (int falls = 0; falls <= periods;) {
    world.step(off_V, dt_s);
    const double now = value();
    if (before > 0 && now <= 0) {
      last_s = world.time_s() - dt_s * now / (now - before);
      if (++falls == 1) first_s = last_s;
    }
    before = now;
  }
  return (last_s - first_s) / periods;
}

}  // namespace accuracy

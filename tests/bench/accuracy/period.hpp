#pragma once
#include <vector>

#include "sim/world/world.hpp"

namespace accuracy {

/// Mean duration of `periods` oscillations of a value of the world, between falling zero crossings; motors at 0 V.
/// Crossings are interpolated between steps.
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

#pragma once
#include <vector>

#include "sim/world/world.hpp"

namespace accuracy {

/// Mean duration of `periods` oscillations of a value of the world, measured between falling zero
/// crossings. The crossings are interpolated between steps. All motors are at 0 V.
double mean_period_s(sim::World& world, int periods, double dt_s, auto&& value) {
  const std::vector<double> off_V(world.actuators().size(), 0.0);
  double first_s = 0, last_s = 0, last_value = value();
  for (int crossings = 0; crossings <= periods;) {
    world.step(off_V, dt_s);
    const double new_value = value();
    if (last_value > 0 && new_value <= 0) {
      last_s = world.time_s() - dt_s * new_value / (new_value - last_value);
      if (++crossings == 1) first_s = last_s;
    }
    last_value = new_value;
  }
  return (last_s - first_s) / periods;
}

}  // namespace accuracy

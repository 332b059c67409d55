#pragma once
#include <cmath>

#include "sim/effects/sensor/sense.hpp"

namespace sim::effects {

/// The disc of an angle sensor does not turn about its centre.
///
///   said = θ + (a sin n θ + b cos n θ − b)/n      n: turns of the disc a turn of what is measured
///
/// Source: data sheets of magnetic and optical encoders, eccentricity error.
template <Sense kind>
struct SensorEccentricity {
  static constexpr Sense sense = kind;
  static constexpr About about{
      word_of<kind>("sensor_shaft_eccentricity", "", "", "sensor_joint_eccentricity"),
      Stage::sensor, seat_of<kind>, "slow motion over a turn of the disc"};

  double sine_rad = 0, cosine_rad = 0;  // a, b

  void visit(auto& v) {
    v("sine_rad", sine_rad, Bounds{-0.3, 0.3});
    v("cosine_rad", cosine_rad, Bounds{-0.3, 0.3});
  }
  double read(double value, const SensorSample& s, Memory&) const {
    return value + error_rad(value, s.turns_per_turn);
  }
  /// Solved by iteration: the error changes by less than 0.6 of a change of the angle.
  double undo(double said, const SensorSample& s, Memory&) const {
    double value = said;
    for (int k = 0; k < 30; ++k) value = said - error_rad(value, s.turns_per_turn);
    return value;
  }

 private:
  double error_rad(double angle, double n) const {
    return (sine_rad * std::sin(n * angle) + cosine_rad * (std::cos(n * angle) - 1)) / n;
  }
};

}  // namespace sim::effects

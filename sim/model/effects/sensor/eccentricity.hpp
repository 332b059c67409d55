#pragma once
#include <cmath>
#include <complex>

#include "sim/model/effects/sensor/sense.hpp"

namespace sim::effects {

/// The disc of an angle sensor does not turn about its centre. In the disc's frame the reading head
/// moves on a circle about the axis c, given relative to the distance between head and axis:
///
///   reading = −arg(e^{−i n θ} − c)/n + const, 0 at θ = 0      c = a + i b
///        ≈ θ + (a sin n θ + b cos n θ − b)/n               n: turns of the disc per turn of θ
///
/// Source: plane geometry of one reading head; data sheets of encoders give the approximation.
template <Sense kind>
struct SensorEccentricity {
  static constexpr Sense sense = kind;
  static constexpr About about{
      by_sensor<kind>("sensor_shaft_eccentricity", "", "", "sensor_joint_eccentricity"),
      Stage::sensor, seat_of<kind>, "slow motion over a full turn of the disc"};

  double sine_rad = 0, cosine_rad = 0;  // a, b

  void visit(auto& v) {
    v("sine_rad", sine_rad, Bounds{-0.3, 0.3});
    v("cosine_rad", cosine_rad, Bounds{-0.3, 0.3});
  }
  double read(double value, const SensorSample& s, Memory&) const {
    const double n = s.turns_per_turn;
    return value + (disc_lead_rad(n * value) - disc_lead_rad(0)) / n;
  }
  double undo(double reading, const SensorSample& s, Memory&) const {
    const double n = s.turns_per_turn;
    return reading - (axis_lag_rad(n * reading + disc_lead_rad(0)) - disc_lead_rad(0)) / n;
  }

 private:
  std::complex<double> centre() const { return {sine_rad, cosine_rad}; }
  /// Angle of the disc minus angle of the axis, for this angle of the axis.
  double disc_lead_rad(double angle) const {
    return -std::arg(1.0 - centre() * std::polar(1.0, angle));
  }
  /// The same for this angle of the disc, from the intersection of its ray with the head's circle.
  double axis_lag_rad(double disc) const {
    const auto centre_in_disc = centre() * std::polar(1.0, disc);
    const double ray_length =
        std::sqrt(1 - centre_in_disc.imag() * centre_in_disc.imag()) - centre_in_disc.real();
    return std::arg(centre_in_disc + ray_length);
  }
};

}  // namespace sim::effects

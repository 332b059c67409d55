#pragma once
#include <algorithm>
#include <array>
#include <cmath>

#include "sim/control/motor_inverse.hpp"
#include "sim/model/actuator/spring.hpp"

/// The elements of puller-follower control (paper, 5.2): the tensions of puller and follower, the
/// reference tension, and the voltage that makes a tension follow its reference.
namespace control {

/// Tensions of a pair: the puller applies the torque, the follower keeps the reference tension.
///
///   F_follower = F_ref,   F_puller = F_ref + |τ| / arm of the puller
///
/// [0] pulls towards positive angles.
struct Pair {
  std::array<double, 2> arm_m;  ///< moment arms, both positive

  bool positive_pulls(double torque_Nm) const { return torque_Nm >= 0; }
  std::array<double, 2> tensions_N(double torque_Nm, double reference_N) const {
    // With different moment arms the reference tension itself causes a torque.
    const double reference_torque_Nm = reference_N * (arm_m[0] - arm_m[1]),
                 net_Nm = torque_Nm - reference_torque_Nm;
    return {reference_N + std::max(0.0, net_Nm) / arm_m[0],
            reference_N + std::max(0.0, -net_Nm) / arm_m[1]};
  }
};

/// The reference tension: low while one muscle clearly pulls, raised around a change of roles. It
/// rises before the change, predicted from the rate of the torque.
///
///   s = max over 0 … lead of (1 − |τ + t dτ/dt| / τ_w)₊²(3 − 2 …),   F_ref = low + s (high − low)
struct ReferenceTension {
  double low_N, high_N, width_Nm, lead_s;

  double of(double torque_Nm, double torque_rate_Nm_per_s) const {
    const double predicted_Nm = torque_Nm + lead_s * torque_rate_Nm_per_s;
    const bool crosses = torque_Nm * predicted_Nm <= 0;
    const double nearest_Nm = crosses ? 0 : std::min(std::abs(torque_Nm), std::abs(predicted_Nm));
    const double x = std::clamp(1 - nearest_Nm / width_Nm, 0.0, 1.0);
    return low_N + x * x * (3 - 2 * x) * (high_N - low_N);
  }
};

/// Input–output linearisation of one tension: with the voltage of the inverse motor model, F obeys
///
///   F̈ = F̈_d + 2 b (Ḟ_d − Ḟ) + b² (F_d − F),     Ḟ = κ (dl/dt + r ω),  F̈ = κ (d²l/dt² + r ω̇)
///
/// κ is the spring's stiffness at F. Its rate of change and the damper are neglected.
class TensionLinearisation {
 public:
  TensionLinearisation(const sim::MotorInverse& motor, const sim::Spring& spring,
                       double bandwidth_per_s)
      : motor_(motor), spring_(spring), b_(bandwidth_per_s) {}

  struct Measured {
    double tension_N, speed_rad_per_s, length_rate_m_per_s, length_acceleration_m_per_s2;
  };
  struct Desired {
    double tension_N, rate_N_per_s, acceleration_N_per_s2;
  };

  double voltage_V(const Measured& measured, const Desired& desired) const {
    const double slope =
        spring_.slope_N_per_m(spring_.stretch_m(std::max(0.0, measured.tension_N)));
    const double r = motor_.radius_m();
    const double rate = slope * (measured.length_rate_m_per_s + r * measured.speed_rad_per_s);
    const double acceleration = desired.acceleration_N_per_s2 +
                                2 * b_ * (desired.rate_N_per_s - rate) +
                                b_ * b_ * (desired.tension_N - measured.tension_N);
    return motor_.voltage_V(measured.tension_N, measured.speed_rad_per_s,
                            (acceleration / slope - measured.length_acceleration_m_per_s2) / r);
  }

 private:
  sim::MotorInverse motor_;
  sim::Spring spring_;
  double b_;
};

}  // namespace control

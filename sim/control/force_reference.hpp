#pragma once
#include "interfaces/robot/robot.hpp"
#include "sim/control/motor_inverse.hpp"
#include "sim/model/actuator/spring.hpp"

/// Reference of an ECU's force law for which a moving tendon has the desired tension.
///
/// The law V = P F_ref − k_i i − k_ω ω − k_F F is exact at rest, ω = 0. At a constant shaft speed ω
/// it reaches V = R i + K_E N ω, so tension f requires
///
///   F_ref = ((R + k_i) i(f, ω, ω̇) + (K_E N + k_ω) ω + k_F f) / P          i: motor_inverse.hpp
///
/// Source: `gain_design.hpp`.
namespace sim {

/// Desired motion of a tendon.
struct TendonMotion {
  double tension_N = 0, tension_rate_N_per_s = 0;
  double length_rate_m_per_s = 0, length_acceleration_m_per_s2 = 0;  ///< of the path length
};

class ForceReference {
 public:
  ForceReference(const erp::Robot& robot, const erp::Actuator& actuator);

  /// F_ref, N, for the shaft speed of the motion:  ω = (ḟ / κ(f) − dl/dt) / r.
  double reference_N(const TendonMotion& motion) const;

 private:
  MotorInverse motor_;
  Spring spring_;
  double per_A_, per_speed_, per_N_;  ///< coefficients of F_ref
};

}  // namespace sim

#pragma once
#include "interfaces/robot/robot.hpp"
#include "sim/control/motor_inverse.hpp"
#include "sim/model/actuator/spring.hpp"

/// What to ask an ECU's force law for, so that a tendon that is being wound pulls as wanted.
///
/// The law V = P F_ref − k_i i − k_ω ω − k_F F is exact at rest, where ω = 0. While the shaft turns
/// at ω it settles where V = R i + K_E N ω, so that for tension f
///
///   F_ref = ((R + k_i) i(f, ω, ω̇) + (K_E N + k_ω) ω + k_F f) / P          i: motor_inverse.hpp
///
/// Source: `design.hpp`.
namespace sim {

/// How a tendon is to move.
struct TendonMotion {
  double tension_N = 0, tension_rate_N_per_s = 0;
  double length_rate_m_per_s = 0, length_acceleration_m_per_s2 = 0;  ///< of its path
};

class ForceReference {
 public:
  ForceReference(const erp::Robot& robot, const erp::Actuator& actuator);

  /// F_ref, N, for the shaft speed that the motion takes:  ω = (ḟ / κ(f) − dl/dt) / r.
  double reference_N(const TendonMotion& motion) const;

 private:
  MotorInverse motor_;
  Spring spring_;
  double per_A_, per_speed_, per_N_;  ///< of F_ref
};

}  // namespace sim

#pragma once
#include <array>

#include "interfaces/robot/robot.hpp"
#include "sim/model/actuator/plane_system.hpp"

/// DC motor, gearbox and spindle (paper, eq. 3), solved exactly for constant V and F.
///
///   L di/dt = V − R i − K_E N ω
///   J dω/dt = e N (K_T i − µ_M N ω − s τ_CM) − µ_G ω − s τ_CG − r F,   J = e J_M N² + J_G
///
/// i current, ω speed of the gearbox shaft (positive: winding up), s = sgn ω, F line tension,
/// r spindle radius. e is the gear's efficiency for the current direction of power:
///
///   motor drives load (T ω ≥ 0):  e = η        load drives motor (T ω < 0):  e = 1/η
///   T = e (N τ_m J_G + J_M N² X) / J,   τ_m = K_T i − µ_M N ω − s τ_CM,   X = µ_G ω + s τ_CG + r F
///
/// T is the mesh torque on the output. Its sign does not depend on e, and at T = 0 both branches
/// agree, so the branch is unique and the gear never generates energy. Eq. 3 is the case e = η. The
/// back-driven branch is an addition: the paper gives eq. 3 only for a motor that drives the load.
///
/// At ω = 0 the shaft sticks (only L di/dt = V − R i) until the current leaves the band
///   N e₋ (K_T i + τ_CM) ≥ r F − τ_CG   and   N η (K_T i − τ_CM) ≤ r F + τ_CG.
///
/// Additional friction and torques (MotorLoad) are inputs of a step and constant over it, like V
/// and F.
/// Ignores: saturation, cogging, heating, backlash, the Stribeck effect.
namespace sim {

struct MotorState {
  double current_A = 0;
  double speed_rad_per_s = 0;  ///< gearbox shaft; exactly 0 while it sticks
  double shaft_rad = 0;        ///< gearbox shaft, since the start; positive: wound up
};

/// Line speed of the unloaded motor at full supply, r V/(K_E N).
inline double top_line_speed_m_per_s(const erp::MotorType& type, double spindle_radius_m) {
  return spindle_radius_m * type.supply_V / (type.back_emf_V_s_per_rad * type.gear_ratio);
}

/// Loads on the gearbox shaft during a step.
struct MotorLoad {
  double tension_N = 0;                                 ///< F
  double extra_winding_Nm = 0, extra_unwinding_Nm = 0;  ///< added to τ_CG winding up and unwinding
  double rotor_Nm = 0;  ///< torque against winding up, on the motor's shaft
};

/// A motor's constants with precomputed matrices. Throws std::invalid_argument if the equations are
/// not stable.
class Motor {
 public:
  /// `usual_step_s`: the dt for which the matrix exponential is precomputed.
  Motor(const erp::MotorType& type, double spindle_radius_m, double usual_step_s = 0.001);

  /// The direction in which a shaft at rest starts to turn; 0 if it sticks.
  int breakaway(double current_A, const MotorLoad& load) const;
  /// True if the motor drives the load at a speed of sign `direction` (sign of the mesh torque).
  bool drives(const MotorState& state, const MotorLoad& load, int direction) const;

  const erp::MotorType& type() const { return type_; }
  double spindle_radius_m() const { return radius_m_; }

 private:
  friend MotorState step(const Motor&, MotorState, double, const MotorLoad&, double);
  friend class MotorRun;
  struct Branch {
    PlaneSystem system;
    PlaneExponential usual_step;
    double efficiency, inertia_kg_m2;  ///< e, J
  };
  struct Band {
    double low_A, high_A;  ///< range of currents at which a shaft at rest sticks
  };
  Branch branch(double efficiency) const;
  /// τ_CG in a direction.
  double dry_friction_Nm(const MotorLoad& load, int direction) const;
  Vec2 input(const Branch& branch, double voltage_V, const MotorLoad& load, int direction) const;
  Band band(const MotorLoad& load) const;
  /// T's sign as a linear function p·(i, ω) + k, times `direction`.
  double mesh_constant(const MotorLoad& load, int direction) const;

  erp::MotorType type_;
  double radius_m_, usual_step_s_;
  std::array<Branch, 2> branches_;  ///< load drives motor, motor drives load
  Vec2 mesh_slope_;
};

/// The state after dt_s at constant voltage and load. Exact for any dt_s ≥ 0, friction included:
/// stops, breakaways and changes of the power direction are located within the step.
MotorState step(const Motor& motor, MotorState state, double voltage_V, const MotorLoad& load,
                double dt_s);
inline MotorState step(const Motor& motor, const MotorState& state, double voltage_V,
                       double tension_N, double dt_s) {
  return step(motor, state, voltage_V, MotorLoad{tension_N}, dt_s);
}

}  // namespace sim

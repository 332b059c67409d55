#pragma once
#include <Eigen/Core>
#include <array>
#include <complex>

#include "firmware/core/parameters.h"
#include "interfaces/robot/robot.hpp"

/// The numbers an ECU channel is given, designed on the host from the robot's constants.
///
/// Force law, V = P F_ref − k·(i, ω, F), on eq. 3 with the far end of the tendon held:
///
///   ẋ = A x + B V,  x = (i, ω, F),  dF/dt = κ r ω + D r dω/dt          (eqs 1, 2, 4)
///   x⁺ = Φ x + Γ V                          zero-order hold over the control period
///   k = [0 0 1] [Γ ΦΓ Φ²Γ]⁻¹ p(Φ)           Ackermann's formula, p the desired polynomial
///   P = 1 / (C (I − Φ + Γ k)⁻¹ Γ)           prefilter: unit gain from F_ref to F at rest
///
/// By default only the slow pole (the tendon being wound up) is moved; the motor's two own poles
/// stay where they are, which asks least of current and speed and so passes on least noise.
///
/// What is left at rest: the design knows no Coulomb friction. The shaft may stick anywhere inside
/// its band of currents, so F rests within ±(R + k_i) τ_Ctot / (η N K_T P) of the reference
/// (`resting_error_N`: about 0.01 N on hinge_rig). Letting out, the gear is back-driven (1/η): the
/// true inertia is 2.9 times the model's and the load helps less; the poles move, the rest is the
/// same band seen from above, wider by the same factor.
///
/// Length, V = kp (θ_ref − θ): kp = K_E N λ_m / 4, λ_m the mechanical pole: critically damped.
/// Current, PID: kp = L b, ki = R b, kd = 0, which cancels R/L; b = 0.3 / period: at 500 Hz the
/// winding is faster than the loop, and 0.3 of the error goes each period.
/// Limits: trips at 1.5 times the current limit and 1.2 times the largest tension, within the
/// converters' ranges; the spindle may wind `line_travel_m` either way.
/// Source of the rules: chosen; of the force law: paper, 5.1.
namespace sim {

struct DesignOptions {
  double period_s = 0.002;          ///< paper, 5.1: 500 Hz
  double force_bandwidth_per_s = 35;  ///< where the slow pole goes; chosen, see design_test.cpp
  /// All three poles of the force loop, s-plane; all zero: the motor's own and the bandwidth.
  std::array<std::complex<double>, 3> force_poles_per_s{};
  double line_travel_m = 0.2;       ///< chosen; fits the 22 bits of a CAN set-point
};

using EcuParameters = std::array<float, ECU_PARAMETER_COUNT>;

/// Continuous x = (i, ω, F): ẋ = A x + B V.
struct ForceModel {
  Eigen::Matrix3d a;
  Eigen::Vector3d b;
};
ForceModel force_model(const erp::MotorType& motor, const erp::Tendon& tendon, double radius_m);

struct ForceGains {
  Eigen::RowVector3d feedback;  ///< V/A, V s/rad, V/N
  double prefilter_V_per_N;
};

/// Throws std::invalid_argument: poles unstable or not in conjugate pairs, period not positive.
ForceGains design_force(const ForceModel& model, const DesignOptions& options);

/// The most by which Coulomb friction keeps the tension from the reference, winding up.
double resting_error_N(const erp::MotorType& motor, const ForceGains& gains);

/// The whole list of firmware/core/parameters.h, in its order.
EcuParameters design_parameters(const erp::Robot& robot, const erp::Actuator& actuator,
                                const DesignOptions& options);

}  // namespace sim

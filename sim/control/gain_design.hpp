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
/// What is left at rest: the design knows no Coulomb friction and no back-driving. The shaft may
/// stick at any current of its band, so that F rests between (`resting_band`)
///
///   F_ref − (R + k_i) (i_up − i_0) / P       wound up to it:  i_up the current that just winds
///   F_ref + (R + k_i) (i_0 − i_down) / k_F   let out to it:   i_down the current that just holds
///
/// with i_0 = r F_ref / (η N K_T), the current the design counts on. On hinge_rig at 40 N that is
/// −0.01 N and +0.05 N. Letting out, the moving masses weigh 1/η² = 2.9 times as much in the
/// model's terms; the loop stays stable (design_test.cpp).
///
/// Length, V = kp (θ_ref − θ): kp = K_E N λ_m / 4, λ_m the mechanical pole: critically damped.
/// Current, PID: kp = L b, ki = R b, kd = 0, which cancels R/L; b = 0.3 / period: at 500 Hz the
/// winding is faster than the loop, and 0.3 of the error goes each period.
/// Limits: trips at 1.5 times the current limit and 1.2 times the largest tension, within the
/// converters' ranges; the spindle may wind `line_travel_m` either way.
/// Sensors: a converter is expected to be noisy where its noise is a quantum or more: one that
/// rests for 50 ticks then does so once in 10²⁰. The potentiometer may be off by 0.1 rad (play, a
/// shaft that twists), six times its noise, and two quanta. It counts if it hangs on the actuator's
/// own ECU.
/// Source of the rules: chosen; of the force law: paper, 5.1.
namespace sim {

struct DesignOptions {
  double period_s = 0.002;            ///< paper, 5.1: 500 Hz
  double force_bandwidth_per_s = 35;  ///< where the slow pole goes; chosen, see design_test.cpp
  /// All three poles of the force loop, s-plane; all zero: the motor's own and the bandwidth.
  std::array<std::complex<double>, 3> force_poles_per_s{};
  /// A reading that rests is a fault while the shaft turns faster than this share of the no-load
  /// speed; chosen. 0: never, as where a sensor may be one that robot.xml does not describe.
  double stuck_share = 0.1;
  double line_travel_m = 0.2;  ///< chosen; fits the 22 bits of a CAN set-point
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

/// Where the tension may rest, relative to the reference. Friction of the motor, no noise.
struct RestingBand {
  double below_N, above_N;
};
RestingBand resting_band(const erp::MotorType& motor, double radius_m, const ForceGains& gains,
                         double force_N);

/// The whole list of firmware/core/parameters.h, in its order.
EcuParameters design_parameters(const erp::Robot& robot, const erp::Actuator& actuator,
                                const DesignOptions& options);

}  // namespace sim

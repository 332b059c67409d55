#pragma once
#include <Eigen/Core>
#include <array>
#include <complex>

#include "firmware/core/parameters.h"
#include "interfaces/robot/robot.hpp"

/// Parameters of an ECU channel, computed on the host from the robot's constants.
///
/// Force law, V = P F_ref − k·(i, ω, F), designed for eq. 3 with the distal end of the tendon
/// fixed:
///
///   ẋ = A x + B V,  x = (i, ω, F),  dF/dt = κ r ω + D r dω/dt          (eqs 1, 2, 4)
///   x⁺ = Φ x + Γ V                          zero-order hold over the control period
///   k = [0 0 1] [Γ ΦΓ Φ²Γ]⁻¹ p(Φ)           Ackermann's formula, p the desired polynomial
///   P = 1 / (C (I − Φ + Γ k)⁻¹ Γ)           prefilter: unit gain from F_ref to F at rest
///
/// By default only the slow pole (winding up the tendon) is moved. The two poles of the motor stay
/// unchanged, which needs the smallest gains on current and speed and amplifies the least noise.
///
/// Steady-state error: the design ignores Coulomb friction and back-driving. The shaft may stick at
/// any current within the friction band, so F at rest is between (`resting_band`)
///
///   F_ref − (R + k_i) (i_up − i_0) / P       after winding up; i_up: least current that winds up
///   F_ref + (R + k_i) (i_0 − i_down) / k_F   after unwinding; i_down: least current that holds
///
/// with i_0 = r F_ref / (η N K_T), the current that the design assumes. On hinge_rig at 40 N the
/// limits are −0.01 N and +0.05 N. While unwinding, the moving inertia is effectively 1/η² = 2.9
/// times that of the model; the loop stays stable (gain_design_test.cpp).
///
/// Length, V = kp (θ_ref − θ): kp = K_E N λ_m / 4, λ_m the mechanical pole: critically damped.
/// Current, PID: kp = L b, ki = R b, kd = 0, which cancels R/L; b = 0.3 / period: at 500 Hz the
/// winding is faster than the loop, and the error decreases by 30 % per period.
/// Limits: trips at 1.5 times the current limit and 1.2 times the largest tension, within the
/// converters' ranges. The line may travel `line_travel_m` in either direction.
/// Sensors: the reading of a converter with noise of one quantization step or more must vary. A
/// constant reading for 50 ticks has a probability of 10⁻²⁰. The tolerance of the potentiometer is
/// 0.1 rad (backlash, torsion of the shaft), plus six times its noise, plus two quantization steps.
/// The potentiometer is used if it is connected to the actuator's own ECU.
/// The rules are chosen. Source of the force law: paper, 5.1.
namespace sim {

struct DesignOptions {
  double period_s = 0.002;            ///< paper, 5.1: 500 Hz
  double force_bandwidth_per_s = 35;  ///< slow pole; chosen, see gain_design_test.cpp
  /// All three poles of the force loop, s-plane; all zero: the motor's poles and the bandwidth.
  std::array<std::complex<double>, 3> force_poles_per_s{};
  /// A constant reading is a fault while the shaft turns faster than this fraction of the no-load
  /// speed; chosen. 0: never, for sensors that robot.xml may not describe.
  double stuck_speed_fraction = 0.1;
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

/// Throws std::invalid_argument for poles that are unstable or not in conjugate pairs, or a period
/// that is not positive.
ForceGains design_force(const ForceModel& model, const DesignOptions& options);

/// Range of the tension at rest, relative to the reference, due to friction of the motor. No noise.
struct RestingBand {
  double below_N, above_N;
};
RestingBand resting_band(const erp::MotorType& motor, double radius_m, const ForceGains& gains,
                         double force_N);

/// All parameters of firmware/core/parameters.h, in the same order.
EcuParameters design_parameters(const erp::Robot& robot, const erp::Actuator& actuator,
                                const DesignOptions& options);

}  // namespace sim

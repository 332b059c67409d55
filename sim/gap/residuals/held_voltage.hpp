#pragma once
#include <array>

#include "interfaces/robot/robot.hpp"

/// Motion of current and speed within periods of constant voltage. Currents and angles are sampled
/// at the rows, at the end of each period.
namespace sim::residuals {

/// The exact motion of a motor over two periods, for a constant load τ:
///
///   L di/dt = V − R i − K_E N ω      J dω/dt = K_T N i − τ      J = J_M N² + J_G/η
///
/// The currents at rows 0, 1 and 2 and the voltages between them determine speed and load, and thus
/// the travel of the shaft (first equation). Currents and travel determine the load, independently
/// of the voltages (second equation):
///
///   K_E N (θ_2 − θ_0)/2T = Σ volts_j V_j − R Σ amperes_j i_j
///   τ = K_T N (Σ drives_j i_j + drives_per_V V_0 + drives_per_speed (θ_2 − θ_0)/2T)
///       − inertia (θ_2 − 2 θ_1 + θ_0)/T²
///
/// V_j: voltage in the period that ends at row j. If the driver has a delay, V_0 still acts in the
/// first part of the period of V_1; without a delay its weights are 0. J_G: inertia behind a
/// gearbox of efficiency η. Ignores: viscous friction within a period.
/// Source: paper, eq. 3, as linear equations with constant V and τ.
struct TwoPeriods {
  std::array<double, 3> volts, amperes, drives;  ///< each sums to 1; drives only without a delay
  double drives_per_V = 0, drives_per_speed = 0;
  double inertia_kg_m2;  ///< less than J because the current falls while the motor accelerates
};
/// `delay_s`: of the driver, at least 0 and less than a period.
TwoPeriods two_periods(const erp::MotorType& motor, double period_s, double delay_s = 0);

/// The weights for a winding that warms up. They are recomputed if its resistance changes by more
/// than a thousandth.
class TwoPeriodsAt {
 public:
  TwoPeriodsAt(const erp::MotorType& motor, double period_s, double delay_s = 0)
      : motor_(motor),
        period_s_(period_s),
        delay_s_(delay_s),
        two_(two_periods(motor, period_s, delay_s)) {}
  const TwoPeriods& at(double resistance_ohm);

 private:
  erp::MotorType motor_;
  double period_s_, delay_s_;
  TwoPeriods two_;
};

/// J = J_M N² + J_G/η.
double shaft_inertia_kg_m2(const erp::MotorType& motor);

}  // namespace sim::residuals

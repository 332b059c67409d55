#pragma once
#include <array>

#include "interfaces/robot/robot.hpp"

/// What current and speed do within periods over which the voltage is held, seen from the rows at
/// their ends, where currents and angles are sampled.
namespace sim::residuals {

/// A motor over two periods, exactly, if its load τ stays:
///
///   L di/dt = V − R i − K_E N ω      J dω/dt = K_T N i − τ      J = J_M N² + J_G/η
///
/// From the currents at rows 0, 1 and 2 and the voltages between them follow the speed and the load,
/// and so how far the shaft turns; from the currents and the turns follows the load, whatever the
/// voltages were:
///
///   K_E N (θ_2 − θ_0)/2T = Σ volts_j V_j − R Σ amperes_j i_j
///   τ = K_T N (Σ drives_j i_j + drives_per_V V_0 + drives_per_speed (θ_2 − θ_0)/2T)
///       − inertia (θ_2 − 2 θ_1 + θ_0)/T²
///
/// V_0 acts where a driver is late, in the first part of the period in which V_1 is given; where none is, its
/// weights are 0. Indices count periods and rows; J_G turns behind a gearbox of efficiency η. Ignores: viscous
/// friction within a period. Source: paper, eq. 3, as linear equations with V and τ held.
struct TwoPeriods {
  std::array<double, 3> volts, amperes, drives;  ///< sum to 1; drives only where no driver is late
  double drives_per_V = 0, drives_per_speed = 0;
  double inertia_kg_m2;  ///< less than J: the current falls as the motor speeds up
};
/// `late_s`: 0 … less than a period.
TwoPeriods two_periods(const erp::MotorType& motor, double period_s, double late_s = 0);

/// The same where the winding warms: anew when its resistance has moved by a thousandth.
class TwoPeriodsAt {
 public:
  TwoPeriodsAt(const erp::MotorType& motor, double period_s, double late_s = 0)
      : motor_(motor),
        period_s_(period_s),
        late_s_(late_s),
        two_(two_periods(motor, period_s, late_s)) {}
  const TwoPeriods& ohm(double resistance_ohm);

 private:
  erp::MotorType motor_;
  double period_s_, late_s_;
  TwoPeriods two_;
};

/// J, as above.
double turned_inertia_kg_m2(const erp::MotorType& motor);

}  // namespace sim::residuals

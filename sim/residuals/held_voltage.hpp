#pragma once
#include "interfaces/robot/robot.hpp"

/// What current and speed do within a period over which the voltage is held, seen from its end,
/// where they are sampled.
namespace sim::residuals {

/// How far the current trails a voltage that is held and a speed that changes evenly: of the
/// current that a period began with, a part is still there at its end.
///
///   t = L/R − T / (e^(T R/L) − 1),  of small L/R: L/R itself; of large: T/2
double trail_s(const erp::MotorType& motor, double period_s);

/// How late the current at a row answers to the speed, R i_k = V − K_E N (⟨ω⟩ − t ⟨ω̇⟩) in the mean
/// over rows: by the winding, L/R, and because within a period the speed does not rise evenly but
/// settles.
double current_lag_s(const erp::MotorType& motor, double period_s);

/// What multiplies ω̇ in the gearbox's balance: J_M N² + J_G/η, less what the current changes within
/// a period, seen from its end. It falls as the motor speeds up, i = i_k + (K_E N/R)(ω_k − ω),
/// after a start from the last period's end that is over in L/R.
/// `sampled`: the share in which currents are those at the rows, not means around them.
double balance_inertia(const erp::MotorType& motor, double period_s, double sampled = 1);

}  // namespace sim::residuals

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

/// The mean speed over a period, (θ_k − θ_k−1)/T = (1 − s) ω_k + s ω_k−1: s, a half where the speed
/// rises evenly, less where it settles. Periods weighed so make ω into differences of θ:
///
///   (1 − s) (ω_k+1 − ω_k) + s (ω_k − ω_k−1) = (θ_k+1 − 2 θ_k + θ_k−1)/T
double mean_speed_share(const erp::MotorType& motor, double period_s);

/// The share d of a period's beginning in what the current answers with over all of it, i without
/// what is left of the current before, but for second differences of ω,
///
///   (1 − d) (V − R i)_k + d (V − R i)_k−1 = K_E N (θ_k − θ_k−1)/T
///
/// a half where the speed rises evenly; less by the winding's L/R, and where it settles.
double earlier_share(const erp::MotorType& motor, double period_s);

/// What multiplies ω̇ in the gearbox's balance: J_M N² + J_G/η, less what the current changes within
/// a period, seen from its end. It falls as the motor speeds up, i = i_k + (K_E N/R)(ω_k − ω),
/// after a start from the last period's end that is over in L/R.
/// `sampled`: the share in which currents are those at the rows, not means around them.
double balance_inertia(const erp::MotorType& motor, double period_s, double sampled = 1);

}  // namespace sim::residuals

#pragma once
#include "sim/gap/residuals/skeletal.hpp"
#include "sim/model/actuator/tendon.hpp"
#include "sim/model/effects/acting.hpp"

/// The quantities of one actuator's chain at the rows of a recording, computed with the effects of
/// a robot: first the sensors' effects are inverted, then the quantities of each stage are computed
/// from the measurements at its ends.
namespace sim::residuals {

struct ChainModel {
  const erp::MotorType& motor;
  const erp::Actuator& actuator;
  effects::Acting effects;  ///< a copy because effects have state from row to row
  double initial_length_m;  ///< length of the path at the initial pose
  double shaft_step_rad;    ///< of the encoder; 0: not specified
};

/// A signal that cannot be computed from the recorded ones is empty.
struct ChainTrace {
  Signal speed_rad_per_s;  ///< ω
  Signal shaft_rad;        ///< θ
  Signal terminal_V;       ///< V at the motor's terminals
  Signal resistance_ohm;   ///< R
  Signal current_A;        ///< i at the row
  Signal tension_N;        ///< F at the far end: measured or, without a sensor, `spring_N`
  Signal spring_N;         ///< F by the spring's law
  Signal path_slope;       ///< ∂(length with effects)/∂(length)
  Signal motor_Nm;         ///< N K_T ī
  Signal drive_Nm;         ///< N (K_T ī − s τ_CM) − X/e; NaN where the shaft rests
  Signal uncertainty_Nm;   ///< of drive_Nm where the shaft reverses or stops
  bool tension_measured = false, current_measured = false;
  double driver_delay_s = 0;  ///< less than a period: whole periods are compensated in `terminal_V`
  double current_averaged = 0;  ///< 0: current at the row; 1: mean current around the row
};

/// Computes the trace of one chain. `path`: smoothed. `other`: a trace of the same rows by another
/// model, or null; its speeds are reused if the angles are equal.
ChainTrace trace(ChainModel model, const ActuatorSignals& measured, const PathTrace& path,
                 double period_s, double speed_half_width_s, const ChainTrace* other = nullptr);

}  // namespace sim::residuals

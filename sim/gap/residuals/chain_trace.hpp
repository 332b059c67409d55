#pragma once
#include "sim/model/actuator/tendon.hpp"
#include "sim/model/effects/acting.hpp"
#include "sim/gap/residuals/skeletal.hpp"

/// One actuator's chain over the rows of a recording, as a robot with effects explains it: sensors
/// undone, then from the measured ends of each stage what lies between.
namespace sim::residuals {

struct ChainModel {
  const erp::MotorType& motor;
  const erp::Actuator& actuator;
  effects::Acting effects;  ///< a copy: remembers from row to row
  double start_m;           ///< length of the path at the initial pose
  double shaft_step_rad;    ///< of its encoder; 0: not specified
};

/// Empty: not to be had from what was recorded.
struct ChainTrace {
  Signal speed_rad_per_s;  ///< ω
  Signal shaft_rad;        ///< θ
  Signal terminal_V;       ///< V at the motor's terminals
  Signal resistance_ohm;   ///< R
  Signal current_A;        ///< i at the row
  Signal tension_N;        ///< F at the far end: measured, or else the spring's
  Signal spring_N;         ///< F as the spring's law has it
  Signal path_slope;       ///< of the effects on the path
  Signal motor_Nm;         ///< N K_T ī
  Signal drive_Nm;         ///< N (K_T ī − s τ_CM) − X/e; NaN where the shaft rests
  Signal unsure_Nm;        ///< by how much that may err where the shaft turns back or stops
  bool tension_measured = false, current_measured = false;
  double driver_late_s = 0;     ///< less than a period: whole ones are undone in `terminal_V`
  double current_averaged = 0;  ///< share in which the current is a mean around the row
};

/// `path`: smoothed. `near`: a trace of the same rows by another model, whose speeds are taken where the angles are
/// the same.
ChainTrace trace(ChainModel model, const ActuatorSignals& measured, const PathTrace& path,
                 double period_s, double speed_half_width_s, const ChainTrace* near = nullptr);

}  // namespace sim::residuals

#pragma once
#include "sim/gap/residuals/episode.hpp"

/// Drives without a tendon, seen as chains that end at the gearbox shaft.
///
///   J θ̈ = N (K_T i − …) − X/e        J with the load's inertia, of a slide m (m_per_rad)²
///
/// With a load encoder or a torque sensor the chain goes on, and is that of a muscle: τ takes the
/// place of a tendon's pull on a spindle of 1 m, the transmission that of its spring, which also
/// pushes, and the load is a hinge of the drive's name, angle φ:
///
///   τ = κ (θ − φ) + d (θ̇ − φ̇)        J_load φ̈ = τ − friction
///
/// A control is worked out from what was measured at a row and held until the next: as a voltage
/// it comes a row late; as a current or force it gives i as the mean around a row,
/// (u_k−1 + u_k)/2. Of a force K_T is the gain, N = 1 and all inertia is the rotor's.
namespace sim::residuals {

/// The robot with an actuator for each drive, of the drive's name, without a tendon.
erp::Robot as_chains(const erp::Robot& robot);

/// The drive that an actuator of as_chains stands for, if any.
const erp::Drive* drive_of(const erp::Robot& robot, const std::string& actuator);

/// What a drive recorded, or the names of these columns. Position and load: m or rad, by the load;
/// torque: N or Nm.
template <class T>
struct DriveRecord {
  T control_V, position, current_A = {}, load = {}, torque = {};
};
DriveRecord<std::string> drive_columns(const erp::Drive& drive);
ActuatorSignals drive_signals(const erp::Drive& drive, const DriveRecord<Signal>& recorded);
/// φ as its encoder says or, without one, where a rigid transmission brings it.
Signal load_rad(const erp::Drive& drive, const DriveRecord<Signal>& recorded);

}  // namespace sim::residuals

#pragma once
#include "sim/gap/residuals/episode.hpp"

/// Drives without a tendon, modelled as chains that end at the gearbox shaft.
///
///   J θ̈ = N (K_T i − …) − X/e        J includes the load's inertia; for a slide m (m_per_rad)²
///
/// With a load encoder or a torque sensor the chain continues like that of a muscle: τ stands for a tendon's tension at
/// a spindle of 1 m, the transmission for its spring, which also pushes, and the load is a hinge with the drive's name
/// and angle φ:
///
///   τ = κ (θ − φ) + d (θ̇ − φ̇)        J_load φ̈ = τ − friction
///
/// A control is computed from the measurements at a row and held until the next row. As a voltage it acts one row
/// later; as a current or force it gives i as the mean around a row, (u_k−1 + u_k)/2. For a force, K_T is the gain, N =
/// 1, and all inertia is the rotor's.
namespace sim::residuals {

/// The robot with one more actuator for each drive, with the drive's name and without a tendon.
erp::Robot as_chains(const erp::Robot& robot);

/// The drive that an actuator of as_chains represents, or null.
const erp::Drive* drive_of(const erp::Robot& robot, const std::string& actuator);

/// The recorded signals of a drive, or the names of their columns. Position and load in m or rad, as the load moves;
/// torque in N or Nm.
template <class T>
struct DriveRecord {
  T control_V, position, current_A = {}, load = {}, torque = {};
};
DriveRecord<std::string> drive_columns(const erp::Drive& drive);
ActuatorSignals drive_signals(const erp::Drive& drive, const DriveRecord<Signal>& recorded);
/// φ from its encoder or, without one, with a rigid transmission.
Signal load_rad(const erp::Drive& drive, const DriveRecord<Signal>& recorded);

}  // namespace sim::residuals

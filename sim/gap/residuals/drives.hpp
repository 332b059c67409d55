#pragma once
#include "sim/gap/residuals/episode.hpp"

/// Drives without a tendon, modelled as actuator chains that end at the gearbox shaft.
///
///   J θ̈ = N (K_T i − …) − X/e        J includes the inertia of the load; for a slide m (m_per_rad)²
///
/// With a load encoder or a torque sensor the chain has a tendon stage. The torque τ takes the
/// place of the tension, at a spindle of 1 m. The transmission takes the place of the tendon's
/// spring, but also pushes. The load is a hinge with the drive's name and angle φ:
///
///   τ = κ (θ − φ) + d (θ̇ − φ̇)        J_load φ̈ = τ − friction
///
/// A command u_k is computed from the measurements at row k and held until the next row. A
/// commanded voltage acts one row later. A commanded current or force gives i as the mean around a
/// row, (u_k−1 + u_k)/2. For a force, K_T is the gain, N = 1, and the whole inertia is the rotor's.
namespace sim::residuals {

/// Returns the robot with an additional actuator for each drive. It has the drive's name and a
/// tendon without a path.
erp::Robot as_chains(const erp::Robot& robot);

/// Returns the drive that an actuator of as_chains represents, or null.
const erp::Drive* drive_of(const erp::Robot& robot, const std::string& actuator);

/// The recorded signals of a drive, or the names of their columns. Position and load: in m for a
/// slide, in rad for a shaft; torque: in N or Nm.
template <class T>
struct DriveRecord {
  T control_V, position, current_A = {}, load = {}, torque = {};
};
DriveRecord<std::string> drive_columns(const erp::Drive& drive);
ActuatorSignals drive_signals(const erp::Drive& drive, const DriveRecord<Signal>& recorded);
/// φ from the load encoder. Without one, from the position with a rigid transmission.
Signal load_rad(const erp::Drive& drive, const DriveRecord<Signal>& recorded);

}  // namespace sim::residuals

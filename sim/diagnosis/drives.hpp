#pragma once
#include "sim/diagnosis/episode.hpp"

/// Drives without a tendon, seen as chains that end at the gearbox shaft.
///
///   J θ̈ = N (K_T i − …) − X/e        J with the load's inertia, of a slide m (m_per_rad)²
///
/// A control is worked out from what was measured at a row and held until the next: as a voltage
/// it comes a row late; as a current or force it gives i as the mean around a row,
/// (u_k−1 + u_k)/2. Of a force K_T is the gain, N = 1 and all inertia is the rotor's.
namespace sim::diagnosis {

/// The robot with an actuator for each drive, of the drive's name, without a tendon.
erp::Robot as_chains(const erp::Robot& robot);

/// The drive that an actuator of as_chains stands for, if any.
const erp::Drive* drive_of(const erp::Robot& robot, const std::string& actuator);

/// What a drive recorded, in the order control_V, position (m or rad), current_A; the names of
/// these columns.
std::array<std::string, 3> drive_columns(const erp::Drive& drive);
ActuatorSignals drive_signals(const erp::Drive& drive, const Signal& control_V,
                              const Signal& position, const Signal& current_A);

}  // namespace sim::diagnosis

#pragma once
#include <string>
#include <vector>

#include "interfaces/recording/table.hpp"
#include "interfaces/robot/robot.hpp"

/// Defects of a recording that are visible without the laws of the robot: unknown columns, rows too
/// far apart, a wrong clock, uneven rows.
namespace sim::checks {

/// Returns one message for each defect, with the remedy; empty: no defect.
///
/// - columns that belong to no actuator, joint or drive of the robot; they are ignored
/// - rows further apart than the ECUs' period: fast changes between two rows are not recorded, and
///   the laws of motors and gearboxes do not hold without them. Not checked for drives.
/// - a row period that differs from the ECUs' period by 0.5 to 20 %
/// - rows that deviate by more than 3 % from an even period, unless the frames are numbered
///
/// `name`: of the recording, for the messages.
std::vector<std::string> table_checks(const recording::Table& table, const erp::Robot& robot,
                                      const std::string& name);

}  // namespace sim::checks

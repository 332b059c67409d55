#pragma once
#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

#include "interfaces/recording/mcap_reader.hpp"
#include "interfaces/recording/table.hpp"
#include "interfaces/robot/robot.hpp"

/// Quality of a run from its recording: limits that actuators reached, and errors of joints.
namespace launch {

/// Shares of the rows in which the ECU of an actuator ran, 0 … 1.
struct ActuatorLoad {
  std::string actuator;
  double saturated = 0;  ///< voltage at the supply voltage
  double slack = 0;      ///< tension below the larger of 0.5 N and six times the sensor noise
};
std::vector<ActuatorLoad> actuator_loads(const recording::Table& table, const erp::Robot& robot);

/// References of an actuator that the plant limited or refused, at the end of the recording.
struct LimitedReferences {
  std::string actuator, reason;
  std::uint64_t limited = 0, refused = 0;
};
std::vector<LimitedReferences> limited_references(const recording::McapReader& recording,
                                                  const std::string& robot);

/// Prints one line for each actuator with a share above 5 % or a limited reference, and one row for
/// each joint with a recorded target: errors and a grade.
void print_quality(const recording::McapReader& recording, const recording::Table& table,
                   const erp::Robot& robot, std::ostream& out);

}  // namespace launch

#pragma once
#include <vector>

#include "sim/gap/checks/laws.hpp"

/// Columns that stand still while the others foretell that they move: an unplugged sensor, a channel
/// that froze. An idle motor's voltage and current, and a slack tendon's tension, may stand still.
namespace sim::checks {

struct DeadColumn {
  Column column;
  double value;             ///< that it says
  std::size_t from, until;  ///< rows
  bool all_along;
  std::vector<Column> evidence;  ///< what moves meanwhile
};

/// Every signal says one value all along, and no sensor even makes noise: no recording of a robot.
bool nothing_changes(const Episode& episode);

/// For two seconds, or all along.
std::vector<DeadColumn> dead_columns(const Episode& episode, const erp::Robot& robot, Laws& laws);

}  // namespace sim::checks

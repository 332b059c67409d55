#pragma once
#include <vector>

#include "sim/gap/checks/laws.hpp"

/// Columns that are constant although other columns imply that they change: an unplugged sensor, a
/// frozen channel. The voltage and current of an idle motor and the tension of a slack tendon may
/// be constant.
namespace sim::checks {

struct DeadColumn {
  Column column;
  double value;            ///< the constant value
  std::size_t first, end;  ///< rows `first` … `end` − 1
  bool whole_recording;
  std::vector<Column> evidence;  ///< columns that change meanwhile
};

/// Returns whether every signal is constant, without any sensor noise. A recording of a robot is
/// never constant.
bool nothing_changes(const Episode& episode);

/// Returns the columns that are dead for at least two seconds, or in the whole recording.
std::vector<DeadColumn> dead_columns(const Episode& episode, const erp::Robot& robot, Laws& laws);

}  // namespace sim::checks

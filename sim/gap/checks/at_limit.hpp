#pragma once
#include <vector>

#include "sim/gap/residuals/column.hpp"

/// Converters at the end of their range: they say that, and not what was beyond.
namespace sim::checks {

struct AtLimit {
  residuals::Column column;
  double limit = 0;  ///< in the column's unit
  double share = 0;  ///< of the rows that were taken
};

/// Currents and tensions that stand at the end of their range in more than 2 % of the rows. A
/// slack tendon's zero is no end.
std::vector<AtLimit> at_limit(const residuals::Episode& episode, const erp::Robot& robot);

}  // namespace sim::checks

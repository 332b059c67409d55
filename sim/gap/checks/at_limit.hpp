#pragma once
#include <vector>

#include "sim/gap/residuals/column.hpp"

/// Converters at the end of their range. Their readings are bounds, not values.
namespace sim::checks {

struct AtLimit {
  residuals::Column column;
  double limit = 0;  ///< in the column's unit
  double share = 0;  ///< of the valid rows
};

/// Currents and tensions that are at the end of their range in more than 2 % of the rows. The zero tension of a
/// slack tendon is not an end of the range.
std::vector<AtLimit> at_limit(const residuals::Episode& episode, const erp::Robot& robot);

}  // namespace sim::checks

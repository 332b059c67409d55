#pragma once
#include "interfaces/recording/table.hpp"
#include "sim/control/holding.hpp"

/// From where the joints shall be to how long the lines shall be.
namespace sim {

/// The poses of a table, a row each: columns <j>.angle_rad, or <j>.qw … <j>.qz of a spherical
/// joint; joints without a column stay where they start. Throws std::invalid_argument, naming the
/// column that belongs to no joint, the row and joint out of range; or a table without rows.
std::vector<TimedPose> poses_of(const recording::Table& table, const erp::Robot& robot);

/// The table of poses, as poses_of reads it: to a microradian and a microsecond.
recording::Table table_of(const std::vector<TimedPose>& poses, const erp::Robot& robot);

struct PlanOptions {
  HoldingOptions holding;
  double sample_s = 0.05;  ///< between poses farther apart than this
};

struct LengthPlan {
  recording::Table table;
  double unbalanced_Nm = 0, at_s = 0;  ///< the most that no tensions could hold, and when
};

/// A trajectory for `target`: the line lengths that hold each pose at its time; and between two
/// poses those that hold the joints on their way, straight and with the least jerk.
LengthPlan lengths_through(const erp::Robot& robot, const std::vector<TimedPose>& poses,
                           const PlanOptions& options = {});

}  // namespace sim

#pragma once
#include "interfaces/recording/table.hpp"
#include "sim/control/holding.hpp"

/// Conversion of desired joint poses to desired line lengths.
namespace sim {

/// The poses of a table, one per row: columns `<j>.angle_rad`, or `<j>.qw … <j>.qz` for a spherical
/// joint. Joints without a column keep their starting position. Throws std::invalid_argument for a
/// column that belongs to no joint, a value out of range (with row and joint), or a table without
/// rows.
std::vector<TimedPose> poses_of(const recording::Table& table, const erp::Robot& robot);

/// The inverse of poses_of: the table of poses, rounded to a microradian and a microsecond.
recording::Table table_of(const std::vector<TimedPose>& poses, const erp::Robot& robot);

struct PlanOptions {
  HoldingOptions holding;
  double sample_s = 0.05;  ///< interval of rows between two poses
};

struct LengthPlan {
  recording::Table table;
  double unbalanced_Nm = 0, at_s = 0;  ///< largest residual torque, and its time
};

/// A trajectory of line lengths for the component `target`. It holds each pose at its time. Between
/// two poses it holds the joints on a straight minimum-jerk trajectory.
LengthPlan lengths_through(const erp::Robot& robot, const std::vector<TimedPose>& poses,
                           const PlanOptions& options = {});

}  // namespace sim

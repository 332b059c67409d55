#pragma once
#include <Eigen/Core>
#include <vector>

#include "interfaces/recording/table.hpp"
#include "sim/control/equilibrium.hpp"
#include "sim/learning/calibration/parameters.hpp"

/// Poses in which a robot stood still, and how far a candidate's are from them (paper, 4.4).
namespace sim::calibration {

/// One: what its actuators had wound, and where its joints were.
struct StillPose {
  double time_s = 0;
  std::vector<double> shaft_rad;  ///< by actuator
  Pose pose;                      ///< by joint
};

struct StillOptions {
  double still_s = 0.5;      ///< so long at least, its mean is the pose; chosen
  double turns_rad = 0.005;  ///< joints that move less than that over it stand still; chosen
  double apart_rad = 0.02;   ///< a pose that is nearer to the one before is the same; chosen
};
/// Of a recording, in the order of time. Throws std::invalid_argument naming a joint or actuator
/// that the table has no columns of, or where nothing ever stood still.
std::vector<StillPose> still_poses(const recording::Table& table, const erp::Robot& robot,
                                   const StillOptions& options = {});

/// Every second to check with, the others to learn from: what was led through between two poses of
/// a plan (`erp calibrate plan`) comes after the first of them.
struct PoseSet {
  std::vector<StillPose> learn, check;
};
PoseSet split(std::vector<StillPose> poses);

/// Where the candidate would be, beside where the robot was.
struct PoseErrors {
  std::vector<double> mean_rad;  ///< by joint that moves: of the angle between
  double mean_of_all_rad = 0;
};
/// `there`: by pose, where it stood instead.
PoseErrors errors_between(const erp::Robot& robot, std::span<const StillPose> poses,
                          std::span<const Pose> there);
/// The shafts of each pose are given to the candidate; it rests where statics lets it.
PoseErrors pose_errors(const Candidate& candidate, std::span<const StillPose> poses);

}  // namespace sim::calibration

#pragma once
#include <Eigen/Core>
#include <vector>

#include "interfaces/recording/table.hpp"
#include "sim/control/equilibrium.hpp"
#include "sim/learning/calibration/parameters.hpp"

/// Poses of a robot at rest, and the errors of a candidate's poses (paper, 4.4).
namespace sim::calibration {

/// A pose at rest: shaft angles and joint positions.
struct StillPose {
  double time_s = 0;
  std::vector<double> shaft_rad;  ///< by actuator
  Pose pose;                      ///< by joint
};

struct StillOptions {
  double still_s = 0.5;      ///< minimum duration at rest; the pose is the mean over it; chosen
  double turns_rad = 0.005;  ///< largest joint motion that counts as rest; chosen
  double apart_rad = 0.02;  ///< a pose nearer than this to the previous one is a repetition; chosen
};
/// The poses at rest of a recording, in the order of time. Throws std::invalid_argument if the
/// table lacks the columns of a joint or actuator, or if the robot is never at rest.
std::vector<StillPose> still_poses(const recording::Table& table, const erp::Robot& robot,
                                   const StillOptions& options = {});

/// Training poses and check poses. `split` assigns every second pose to the check: in a recording
/// of `erp calibrate tour` these are the midway poses.
struct PoseSet {
  std::vector<StillPose> learn, check;
};
PoseSet split(std::vector<StillPose> poses);

/// Errors of a candidate's poses relative to the robot's.
struct PoseErrors {
  std::vector<double> mean_rad;  ///< mean angle between the two, by movable joint
  double mean_of_all_rad = 0;
};
/// `candidate_poses`: the candidate's pose for each of `poses`.
PoseErrors errors_between(const erp::Robot& robot, std::span<const StillPose> poses,
                          std::span<const Pose> candidate_poses);
/// Errors of the candidate's static equilibria at the shaft angles of each pose.
PoseErrors pose_errors(const Candidate& candidate, std::span<const StillPose> poses);

}  // namespace sim::calibration

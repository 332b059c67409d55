#pragma once
#include <cstdint>
#include <random>

#include "interfaces/recording/table.hpp"
#include "sim/control/holding.hpp"

/// The postures that a robot's muscles can hold: the domain of learning and of its evaluation.
namespace sim::muscle_networks {

struct WorkspaceOptions {
  double ball_rad = 1;      ///< largest rotation of ball joints from their start; chosen
  double margin_rad = 0.1;  ///< distance of hinges from their stops; chosen
  double share = 0.5;       ///< largest holding tension, relative to the muscle's maximum; chosen
  double left_Nm = 0.05;    ///< largest gravity torque that may remain unbalanced; chosen
  std::uint64_t seed = 1;
};

class Workspace {
 public:
  /// Throws std::invalid_argument like PoseHolder.
  explicit Workspace(const erp::Robot& robot, const WorkspaceOptions& options = {});

  /// Draws postures uniformly in joint angles and, for ball joints, in the rotation vector, until
  /// one can be held. Throws std::runtime_error after a thousand draws without success.
  Pose draw();

 private:
  Pose random_posture();
  bool is_held(const Pose& pose);

  erp::Robot robot_;
  WorkspaceOptions options_;
  std::vector<erp::Joint> joints_;
  Pose start_;
  PoseHolder holder_;
  std::mt19937_64 random_;
};

/// Random postures as joint readings at rest.
std::vector<std::vector<JointReading>> postures(const erp::Robot& robot, std::size_t count,
                                                const WorkspaceOptions& options = {});

struct JointMotionOptions {
  WorkspaceOptions workspace;
  double duration_s = 240;
  double share = 0.5;  ///< largest line speed, relative to the motor's top speed; chosen
};

/// Joint motion: a sequence of poses that `joint_target` passes through without stopping, beginning
/// at the robot's start. Each pose is drawn from the workspace, far from all previous poses.
/// The duration of a motion is limited by the speed of the motors.
recording::Table joint_motion(const erp::Robot& robot, const JointMotionOptions& options = {});

}  // namespace sim::muscle_networks

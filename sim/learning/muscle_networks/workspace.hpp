#pragma once
#include <cstdint>
#include <random>

#include "interfaces/recording/table.hpp"
#include "sim/control/holding.hpp"

/// The postures that a robot's muscles can hold: what learning has to cover, and is judged over.
namespace sim::muscle_networks {

struct WorkspaceOptions {
  double ball_rad = 1;  ///< ball joints: turned from where they start by at most so much; chosen
  double margin_rad = 0.1;  ///< hinges: this far from their stops; chosen
  double share = 0.5;       ///< of what each muscle may pull at most, to hold it; chosen
  double left_Nm = 0.05;    ///< of gravity's torque that may stay without a holder; chosen
  std::uint64_t seed = 1;
};

class Workspace {
 public:
  /// Throws std::invalid_argument as PoseHolder does.
  explicit Workspace(const erp::Robot& robot, const WorkspaceOptions& options = {});

  /// Uniform in joint angles and, of ball joints, in the rotation vector; drawn until one can be
  /// held. Throws std::runtime_error after a thousand in vain.
  Pose draw();

 private:
  Pose anywhere();
  bool held(const Pose& pose);

  erp::Robot robot_;
  WorkspaceOptions options_;
  std::vector<erp::Joint> joints_;
  Pose start_;
  PoseHolder holder_;
  std::mt19937_64 random_;
};

/// Poses as joints' readings, at rest.
std::vector<std::vector<JointReading>> postures(const erp::Robot& robot, std::size_t count,
                                                const WorkspaceOptions& options = {});

struct JointMotionOptions {
  WorkspaceOptions workspace;
  double duration_s = 240;
  double share = 0.5;  ///< of its top speed, what a motor's line is wound with on the way; chosen
};

/// Joint motion: poses for `joint_target` to go through without a halt, from where the robot starts;
/// each drawn from the workspace where nobody has been yet, as fast as the motors bear.
recording::Table joint_motion(const erp::Robot& robot, const JointMotionOptions& options = {});

}  // namespace sim::muscle_networks

#pragma once
#include <iosfwd>
#include <string>
#include <vector>

#include "sim/learning/muscle_networks/babble.hpp"
#include "sim/learning/muscle_networks/workspace.hpp"

/// `erp model babble`, `erp model motion`, `erp model muscles`: networks for the muscle lengths as
/// a function of the posture, and trajectories for their training data.
namespace launch {

/// Prints a trajectory of random tendon forces for `target`. Throws xml::Errors. Returns the exit
/// code.
int model_babble(const std::string& robot_file, const sim::muscle_networks::BabbleOptions& options,
                 std::ostream& out);

/// Prints poses for `joint_target` that cover the workspace. Throws xml::Errors, and
/// std::runtime_error if there is no such pose. Returns the exit code.
int model_motion(const std::string& robot_file,
                 const sim::muscle_networks::JointMotionOptions& options, std::ostream& out);

struct ModelMusclesOptions {
  std::string robot;
  std::vector<std::string> recordings;
  std::string out;  ///< new file of networks; empty: no file
  int units = 16;   ///< hidden units in the network of each muscle
  double held_out =
      0.1;  ///< fraction at the end of each recording that is used for validation only
  sim::muscle_networks::WorkspaceOptions comparison{
      .seed = 4711};  ///< postures for the comparison of torques
};

/// Trains one network per muscle. Prints the length errors, and the torque error of the learned
/// Jacobian relative to that of robot.xml, over postures that the muscles can hold. Prints the
/// torque error also for a network that is trained online with the same samples. Throws
/// xml::Errors, RecordingError, WriteError, std::invalid_argument. Returns the exit code.
int model_muscles(const ModelMusclesOptions& options, std::ostream& out);

}  // namespace launch

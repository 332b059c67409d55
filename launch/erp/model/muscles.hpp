#pragma once
#include <iosfwd>
#include <string>
#include <vector>

#include "sim/learning/muscle_networks/babble.hpp"
#include "sim/learning/muscle_networks/workspace.hpp"

/// `erp model babble`, `erp model motion`, `erp model muscles`: what the muscles' lengths do over postures, learnt.
namespace launch {

/// Prints a trajectory of tendon forces for `target`. Throws xml::Errors. Returns the exit code.
int model_babble(const std::string& robot_file, const sim::muscle_networks::BabbleOptions& options,
                 std::ostream& out);

/// Prints poses for `joint_target` all over the workspace. Throws as model_babble, std::runtime_error
/// where there is none. Returns the exit code.
int model_motion(const std::string& robot_file, const sim::muscle_networks::JointMotionOptions& options,
                 std::ostream& out);

struct ModelMusclesOptions {
  std::string robot;
  std::vector<std::string> recordings;
  std::string out;        ///< the new file of networks; empty: only tried
  int units = 16;         ///< hidden ones a muscle
  double held_out = 0.1;  ///< share of each recording, its end, that only checks
  sim::muscle_networks::WorkspaceOptions over{.seed = 4711};  ///< where torques are compared
};

/// Learns a network a muscle, prints what it leaves, and how far torques by its Jacobian are off
/// those of robot.xml, over postures that its muscles can hold; also of one learnt on line from the
/// same samples. Throws xml::Errors, RecordingError, WriteError, std::invalid_argument. Returns the
/// exit code.
int model_muscles(const ModelMusclesOptions& options, std::ostream& out);

}  // namespace launch

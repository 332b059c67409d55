#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <string>

/// Where joints were, or should have been, frame by frame.
namespace recording {

class McapReader;

struct JointTrack {
  int dof = 0;  ///< 1: position[0] is an angle, rad; 3: a unit quaternion w x y z
  std::map<std::uint64_t, std::array<double, 4>> at;  ///< by the frame's sequence
};
using JointTracks = std::map<std::string, JointTrack>;  ///< by joint

/// What joint_target asked for ("joint_target"), or the joint_state of a source: "sim",
/// "pose_estimator", "motion_capture". Of frames said twice, the last. Throws RecordingError where
/// there is none such, naming those there are.
JointTracks joint_tracks(const McapReader& recording, const std::string& who);

}  // namespace recording

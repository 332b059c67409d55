#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <string>

/// Measured or desired joint positions, by frame.
namespace recording {

class McapReader;

struct JointTrack {
  int dof = 0;  ///< 1: position[0] is an angle, rad; 3: a unit quaternion w x y z
  std::map<std::uint64_t, std::array<double, 4>> at;  ///< by sequence of the frame
};
using JointTracks = std::map<std::string, JointTrack>;  ///< by joint name

/// The positions of joint_target (`source` "joint_target") or of joint_state by its source: "sim",
/// "pose_estimator", "motion_capture". For a repeated frame, the last message applies. Throws
/// RecordingError with the recorded sources when there is no such source.
JointTracks joint_tracks(const McapReader& recording, const std::string& source);

}  // namespace recording

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
  std::map<std::uint64_t, std::array<double, 4>> positions;  ///< by sequence of the frame
};
using JointTracks = std::map<std::string, JointTrack>;  ///< by joint name

/// The joint positions of one source: "joint_target" (that topic), or "sim", "pose_estimator",
/// "motion_capture" (joint_state). If a frame occurs twice, its last message applies. Throws
/// RecordingError when the source was not recorded; it lists the recorded sources.
JointTracks joint_tracks(const McapReader& recording, const std::string& source);

}  // namespace recording

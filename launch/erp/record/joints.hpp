#pragma once
#include <iosfwd>
#include <string>
#include <vector>

#include "interfaces/recording/joint_tracks.hpp"

/// `erp log joints`: difference between two sources of joint angles.
namespace launch {

struct JointError {
  std::string joint;
  std::size_t frames = 0;
  double rms_rad = 0, largest_rad = 0, largest_at_s = 0;
};

/// Error of each joint that both sources contain. The error of a spherical joint is the angle of
/// the rotation between both poses. Ignores frames before `from_s`.
std::vector<JointError> joint_errors(const recording::JointTracks& actual,
                                     const recording::JointTracks& desired, double from_s);

struct LogJointsOptions {
  std::string source = "sim", reference_source = "joint_target";
  double from_s = 0;
  std::string out;  ///< picture file; empty: none
};

/// Prints one row per joint; draws both sources if `options.out` is not empty. Returns 0 done, 1
/// not written, 2 bad input.
int log_joints(const std::string& path, const LogJointsOptions& options, std::ostream& out);

}  // namespace launch

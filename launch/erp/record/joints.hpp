#pragma once
#include <iosfwd>
#include <string>
#include <vector>

#include "interfaces/recording/joint_tracks.hpp"

/// `erp log joints`: how near one account of the joints is to another.
namespace launch {

struct JointError {
  std::string joint;
  std::size_t frames = 0;
  double rms_rad = 0, largest_rad = 0, largest_at_s = 0;
};

/// Of ball joints the angle of the turn between the two. Frames before `from_s` are left out.
std::vector<JointError> joint_errors(const recording::JointTracks& was,
                                     const recording::JointTracks& wanted, double from_s);

struct LogJointsOptions {
  std::string of = "sim", against = "joint_target";
  double from_s = 0;
  std::string out;  ///< a picture; empty: none
};

/// Prints a row a joint, and draws both. Returns 0 done, 1 could not be written, 2 bad input.
int log_joints(const std::string& path, const LogJointsOptions& options, std::ostream& out);

}  // namespace launch

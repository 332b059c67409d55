#pragma once
#include <optional>
#include <string>
#include <vector>

#include "components/motion_capture/stereo.hpp"
#include "interfaces/robot/robot.hpp"
#include "sim/model/cameras/view.hpp"
#include "sim/model/skeleton/robot_tree.hpp"

/// Which point is which marker.
namespace capture {

using sim::cameras::MarkerConfig;

struct Marker {
  std::size_t body;  ///< of RobotTree::bodies
  sim::Vec3 at_m;
};
/// Throws std::invalid_argument for a body that the robot does not have.
std::vector<Marker> markers_of(std::span<const MarkerConfig> configs, const sim::RobotTree& tree);

/// Where markers were seen; nothing of those that were not.
using Sightings = std::vector<std::optional<sim::Vec3>>;

/// Gives each marker the nearest point to where it is expected, nearest pairs first; a point, and a
/// spot of an image, serves one marker alone. Beyond `gate_m` none.
Sightings follow(std::span<const Marker> markers, std::span<const sim::BodyPose> expected,
                 std::span<const StereoPoint> points, double gate_m);

/// Finds a body of which nothing is known, by the distances between its markers: the pose under
/// which most of them have a point within `within_m`; nothing if fewer than three have.
std::optional<sim::BodyPose> find_body(std::span<const sim::Vec3> in_body_m,
                                       std::span<const StereoPoint> points, double within_m);

/// The pose that brings points of a body nearest to where they were seen (Umeyama 1991). Three or
/// more, not in a row.
sim::BodyPose rigid_pose(std::span<const sim::Vec3> in_body_m, std::span<const sim::Vec3> seen_m);

}  // namespace capture

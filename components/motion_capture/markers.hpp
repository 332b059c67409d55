#pragma once
#include <optional>
#include <string>
#include <vector>

#include "components/motion_capture/stereo.hpp"
#include "interfaces/robot/robot.hpp"
#include "sim/model/cameras/view.hpp"
#include "sim/model/skeleton/robot_tree.hpp"

/// Assignment of points to markers.
namespace capture {

using sim::cameras::MarkerConfig;

struct Marker {
  std::size_t body;  ///< of RobotTree::bodies
  sim::Vec3 at_m;
};
/// Throws std::invalid_argument for a body that the robot does not have.
std::vector<Marker> markers_of(std::span<const MarkerConfig> configs, const sim::RobotTree& tree);

/// Measured positions by marker; nullopt for markers that are not visible.
using MarkerPoints = std::vector<std::optional<sim::Vec3>>;

/// Assigns each marker the point nearest to its predicted position, nearest pairs first, within
/// `gate_m`. Each point and each spot of an image is assigned to one marker only.
MarkerPoints assign_nearest(std::span<const Marker> markers,
                            std::span<const sim::BodyPose> expected,
                            std::span<const StereoPoint> points, double gate_m);

/// Finds a body without prediction, by the distances between its markers: the pose with the most
/// markers that have a point within `tolerance_m`; nullopt if fewer than three have one.
std::optional<sim::BodyPose> find_body(std::span<const sim::Vec3> in_body_m,
                                       std::span<const StereoPoint> points, double tolerance_m);

/// The pose that fits points of a body to measured points by least squares (Umeyama 1991). At least
/// three points, not collinear.
sim::BodyPose rigid_pose(std::span<const sim::Vec3> in_body_m, std::span<const sim::Vec3> seen_m);

}  // namespace capture

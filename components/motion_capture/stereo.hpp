#pragma once
#include <vector>

#include "components/images/spots.hpp"

/// Epipolar matching and triangulation: points from pairs of spots.
///
/// A spot of the left image defines a ray a + s d, one of the right image b + t e. The two match if
/// the rays nearly intersect, which is the epipolar constraint in metres:
///
///   min ‖a + s d − b − t e‖ ≤ gap;     the point is midway between the two closest points
namespace capture {

using images::Spot, images::SpotOptions, images::find_spots;

struct StereoOptions {
  double gap_m = 0.003;                             ///< largest distance of matching rays; chosen
  double min_distance_m = 0.3, max_distance_m = 6;  ///< of a point from each camera; chosen
};

struct StereoPoint {
  sim::Vec3 at_m;
  double gap_m;
  std::size_t left, right;  ///< indices of the spots
};

/// All matching pairs. A spot may be in more than one pair.
std::vector<StereoPoint> triangulate(const sim::cameras::Camera& left_camera,
                                     std::span<const Spot> left,
                                     const sim::cameras::Camera& right_camera,
                                     std::span<const Spot> right, const StereoOptions& options);

}  // namespace capture

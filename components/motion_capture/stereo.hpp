#pragma once
#include <vector>

#include "components/images/spots.hpp"

/// Two spots as one point: epipolar matching and triangulation.
///
/// A spot of the left image is a ray a + s d, one of the right b + t e. The two belong together
/// where the rays nearly meet, which is the epipolar constraint, told in metres:
///
///   min ‖a + s d − b − t e‖ ≤ gap;     the point lies in the middle between the nearest two
namespace capture {

using images::Spot, images::SpotOptions, images::find_spots;

struct StereoOptions {
  double gap_m = 0.003;            ///< chosen
  double near_m = 0.3, far_m = 6;  ///< from each camera
};

struct StereoPoint {
  sim::Vec3 at_m;
  double gap_m;
  std::size_t left, right;  ///< which spots
};

/// All pairs that may belong together: a spot may be in more than one.
std::vector<StereoPoint> triangulate(const sim::cameras::Camera& left_camera,
                                     std::span<const Spot> left,
                                     const sim::cameras::Camera& right_camera,
                                     std::span<const Spot> right, const StereoOptions& options);

}  // namespace capture

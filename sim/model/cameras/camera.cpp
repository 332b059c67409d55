#include "sim/model/cameras/camera.hpp"

#include <Eigen/Geometry>
#include <stdexcept>

namespace sim::cameras {
namespace {

double distortion(const CameraConfig& c, double square) {
  return 1 + square * (c.k1 + square * c.k2);
}

}  // namespace

Camera::Camera(const CameraConfig& config)
    : config_(config),
      at_m_(vec(config.at_m)),
      centre_((config.width_px - 1) / 2.0 + config.centre_u_px,
              (config.height_px - 1) / 2.0 + config.centre_v_px) {
  const Vec3 ahead = vec(config.looks_at_m) - at_m_,
             right = ahead.cross(vec(config.up).normalized());
  if (!(right.norm() > 1e-6 * ahead.norm()))
    throw std::invalid_argument("camera \"" + config.name +
                                "\": the viewing direction is zero or parallel to up; change "
                                "looks_at_m or up, for example up=\"0 1 0\"");
  axes_.col(0) = right.normalized();
  axes_.col(2) = ahead.normalized();
  axes_.col(1) = axes_.col(2).cross(axes_.col(0));
}

std::optional<Pixel> Camera::project(const Vec3& world_m) const {
  constexpr double min_depth_m = 1e-3;  // chosen
  const Vec3 in_camera = axes_.transpose() * (world_m - at_m_);
  if (in_camera.z() < min_depth_m) return std::nullopt;
  const Pixel undistorted = in_camera.head<2>() / in_camera.z();
  return Pixel(config_.focal_px * distortion(config_, undistorted.squaredNorm()) * undistorted +
               centre_);
}

/// Inverts the distortion by fixed-point iteration until a step is below the tolerance. For
/// common lenses each step at least halves the error.
Vec3 Camera::ray(const Pixel& pixel) const {
  constexpr int max_iterations = 20;   // chosen
  constexpr double tolerance = 1e-12;  // of the focal length
  const Pixel distorted = (pixel - centre_) / config_.focal_px;
  Pixel undistorted = distorted;
  for (int k = 0; k < max_iterations; ++k) {
    const Pixel before = undistorted;
    undistorted = distorted / distortion(config_, before.squaredNorm());
    if ((undistorted - before).squaredNorm() < tolerance * tolerance) break;
  }
  return (axes_ * Vec3(undistorted.x(), undistorted.y(), 1)).normalized();
}

}  // namespace sim::cameras

#include "sim/model/cameras/camera.hpp"

#include <Eigen/Geometry>
#include <stdexcept>

namespace sim::cameras {
namespace {

double stretched(const CameraConfig& c, double square) {
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
  constexpr double nearest_m = 1e-3;
  const Vec3 seen = axes_.transpose() * (world_m - at_m_);
  if (seen.z() < nearest_m) return std::nullopt;
  const Pixel flat = seen.head<2>() / seen.z();
  return Pixel(config_.focal_px * stretched(config_, flat.squaredNorm()) * flat + centre_);
}

/// Inverts the distortion by fixed-point iteration until a step is below 1e-12 of the focal length. For
/// common lenses each step at least halves the error.
Vec3 Camera::ray(const Pixel& pixel) const {
  const Pixel bent = (pixel - centre_) / config_.focal_px;
  Pixel flat = bent;
  for (int k = 0; k < 20; ++k) {
    const Pixel before = flat;
    flat = bent / stretched(config_, before.squaredNorm());
    if ((flat - before).squaredNorm() < 1e-24) break;
  }
  return (axes_ * Vec3(flat.x(), flat.y(), 1)).normalized();
}

}  // namespace sim::cameras

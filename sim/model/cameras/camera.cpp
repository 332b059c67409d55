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
                                "\" looks along its up, or at itself: give it another up, such as "
                                "up=\"0 1 0\"");
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

/// The distortion is undone by fixed-point steps, which halve the error and more for lenses in use,
/// until they move it by less than 1e-12 of the focal length.
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

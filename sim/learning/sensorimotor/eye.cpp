#include "sim/learning/sensorimotor/eye.hpp"

#include <stdexcept>

namespace sim::sensorimotor {

Eye::Eye(const cameras::ViewConfig& view, const RobotTree& tree) {
  if (view.cameras.empty() || view.markers.empty())
    throw std::invalid_argument(view.place.file +
                                ": a view needs a <camera> and a <marker>; add the missing one");
  for (const cameras::CameraConfig& camera : view.cameras) cameras_.emplace_back(camera);
  body_ = body_named(tree.names, view.markers.front().body, "a marker");
  at_m_ = vec(view.markers.front().at_m);
}

std::optional<Eigen::VectorXd> Eye::see(std::span<const BodyPose> bodies) const {
  const Vec3 at_m = bodies[body_].position_m + bodies[body_].rotation * at_m_;
  Eigen::VectorXd senses(this->senses());
  for (std::size_t c = 0; c < cameras_.size(); ++c) {
    const auto pixel = cameras_[c].project(at_m);
    if (!pixel || !cameras_[c].sees(*pixel)) return std::nullopt;
    senses.segment<2>(2 * static_cast<Eigen::Index>(c)) = sense(c, *pixel);
  }
  return senses;
}

Eigen::Vector2d Eye::sense(std::size_t camera, const cameras::Pixel& pixel) const {
  const cameras::CameraConfig& c = cameras_[camera].config();
  return {(pixel.x() - (c.width_px - 1) / 2.0 - c.centre_u_px) / c.focal_px,
          (pixel.y() - (c.height_px - 1) / 2.0 - c.centre_v_px) / c.focal_px};
}

std::optional<std::size_t> Eye::camera_named(const std::string& name) const {
  for (std::size_t c = 0; c < cameras_.size(); ++c)
    if (cameras_[c].config().name == name) return c;
  return std::nullopt;
}

}  // namespace sim::sensorimotor

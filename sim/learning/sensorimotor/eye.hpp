#pragma once
#include <Eigen/Core>
#include <optional>
#include <span>

#include "sim/model/cameras/view.hpp"
#include "sim/model/skeleton/robot_tree.hpp"

/// The senses: where in each camera's image a marker is.
///
///   S = (x, y) of each camera, x = (u − c_u)/f to the right, y = (v − c_v)/f down: no unit
namespace sim::sensorimotor {

class Eye {
 public:
  /// The view's first marker. Throws std::invalid_argument: no camera, no marker, or one on a body
  /// that there is not.
  Eye(const cameras::ViewConfig& view, const RobotTree& tree);

  Eigen::Index senses() const { return 2 * std::ssize(cameras_); }
  /// Bodies as RobotTree has them. Nothing: not in every image.
  std::optional<Eigen::VectorXd> see(std::span<const BodyPose> bodies) const;
  /// Of one camera's pixel.
  Eigen::Vector2d sense(std::size_t camera, const cameras::Pixel& pixel) const;
  double focal_px() const { return cameras_.front().config().focal_px; }
  /// Which of them; nothing: none of that name.
  std::optional<std::size_t> camera_named(const std::string& name) const;

 private:
  std::vector<cameras::Camera> cameras_;
  std::size_t body_ = 0;
  Vec3 at_m_ = Vec3::Zero();
};

}  // namespace sim::sensorimotor

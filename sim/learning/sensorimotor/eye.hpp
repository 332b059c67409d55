#pragma once
#include <Eigen/Core>
#include <optional>
#include <span>

#include "sim/model/cameras/view.hpp"
#include "sim/model/skeleton/robot_tree.hpp"

/// The senses: position of a marker in each camera's image.
///
///   S = (x, y) of each camera, x = (u − c_u)/f to the right, y = (v − c_v)/f down; dimensionless
namespace sim::sensorimotor {

class Eye {
 public:
  /// Observes the view's first marker. Throws std::invalid_argument if there is no camera or no
  /// marker, or if the marker's body does not exist.
  Eye(const cameras::ViewConfig& view, const RobotTree& tree);

  Eigen::Index senses() const { return 2 * std::ssize(cameras_); }
  /// The senses; `bodies` in the order of RobotTree. nullopt if the marker is not in every image.
  std::optional<Eigen::VectorXd> see(std::span<const BodyPose> bodies) const;
  /// The senses of a pixel of one camera.
  Eigen::Vector2d sense(std::size_t camera, const cameras::Pixel& pixel) const;
  double focal_px() const { return cameras_.front().config().focal_px; }
  /// Index of a camera; nullopt if no camera has that name.
  std::optional<std::size_t> camera_named(const std::string& name) const;

 private:
  std::vector<cameras::Camera> cameras_;
  std::size_t body_ = 0;
  Vec3 at_m_ = Vec3::Zero();
};

}  // namespace sim::sensorimotor

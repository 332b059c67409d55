#pragma once
#include <random>
#include <span>
#include <string>

#include "interfaces/xml/fields.hpp"
#include "sim/model/skeleton/pose.hpp"
#include "sim/model/skeleton/robot_tree.hpp"

namespace sim {

/// `<hand body="hand" at_m="0 0 -0.1"/>`: the reaching point, in its body's frame.
struct HandConfig {
  static constexpr auto element = "hand";
  static constexpr auto description = "Point of a body that reaches or strikes.";
  xml::Place place;
  std::string body;
  xml::Vec3 at_m{0, 0, 0};
  void visit(auto& v) {
    v.required("body", body, "Body of the hand.");
    v("at_m", at_m, "Position of the reaching point in the frame of the body.");
  }
};

/// `<zone from_m="0.2 -0.3 -0.4" to_m="0.4 0 -0.1"/>`: a box in the world that contains the
/// targets.
struct ZoneConfig {
  static constexpr auto element = "zone";
  static constexpr auto description = "Box in the world that contains the targets of the training.";
  xml::Place place;
  xml::Vec3 from_m{}, to_m{};
  void visit(auto& v) {
    v.required("from_m", from_m, "Corner of the box with the smallest coordinates, in the world.");
    v.required("to_m", to_m, "Corner of the box with the largest coordinates, in the world.");
  }
  /// A random point, uniformly distributed in the box.
  Vec3 draw(auto& random) const {
    Vec3 at_m;
    for (std::size_t k = 0; k < 3; ++k)
      at_m[static_cast<Eigen::Index>(k)] =
          std::uniform_real_distribution<double>(from_m[k], to_m[k])(random);
    return at_m;
  }
  /// True if the point is in the box enlarged by the margin.
  bool contains(const Vec3& at_m, double margin_m) const {
    return ((at_m - vec(from_m)).array() > -margin_m).all() &&
           ((vec(to_m) - at_m).array() > -margin_m).all();
  }
};

class Hand {
 public:
  /// Throws std::invalid_argument for an unknown body.
  Hand(const HandConfig& config, std::span<const std::string> bodies)
      : body_(body_named(bodies, config.body, "a hand")), at_m_(vec(config.at_m)) {}
  /// Position in the world; `bodies` in the order of RobotTree.
  Vec3 in(std::span<const BodyPose> bodies) const {
    return bodies[body_].position_m + bodies[body_].rotation * at_m_;
  }

 private:
  std::size_t body_;
  Vec3 at_m_;
};

}  // namespace sim

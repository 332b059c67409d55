#pragma once
#include <span>
#include <string>

#include "interfaces/xml/fields.hpp"
#include "sim/skeleton/robot_tree.hpp"
#include "sim/skeleton/pose.hpp"

namespace sim {

/// `<hand body="hand" at_m="0 0 -0.1"/>`: the point that reaches, in its body's frame.
struct HandConfig {
  static constexpr auto element = "hand";
  xml::Place place;
  std::string body;
  xml::Vec3 at_m{0, 0, 0};
  void visit(auto& v) { v.required("body", body), v("at_m", at_m); }
};

class Hand {
 public:
  /// Throws std::invalid_argument: no such body.
  Hand(const HandConfig& config, std::span<const std::string> bodies)
      : body_(body_named(bodies, config.body, "a hand")), at_m_(vec(config.at_m)) {}
  /// In the world; bodies as RobotTree has them.
  Vec3 in(std::span<const BodyPose> bodies) const {
    return bodies[body_].position_m + bodies[body_].rotation * at_m_;
  }

 private:
  std::size_t body_;
  Vec3 at_m_;
};

}  // namespace sim

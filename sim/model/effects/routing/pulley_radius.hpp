#pragma once
#include <cmath>
#include <variant>

#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// Change of the radius of the pulleys; guides close to a pulley move with its rim.
///
///   r_P' = (1 + a) r_P
///
/// A guide is a neighbouring path point within 1.1 r_P of the centre, on the pulley's body or on a
/// body whose joint is at that centre.
/// Source: paper, 4.1 (wrapping around spheres).
struct RoutingPulleyRadius {
  static constexpr About about{"routing_pulley_radius", Stage::routing, Seat::actuator,
                               "the whole range of the joint"};

  double relative = 0;  // a

  void visit(auto& v) { v("relative", relative, Bounds{-0.5, 1}); }
  void change_robot(auto& robot, const auto& on) const {
    for (auto& actuator : robot.actuators)
      if (actuator.name == on) widen(robot, actuator.tendon.path);
  }

 private:
  static constexpr double guide_radii = 1.1;  // chosen

  void widen(const auto& robot, auto& path) const {
    for (std::size_t k = 0; k < path.size(); ++k) {
      const auto widen_here = [&](auto& pulley) {
        if constexpr (requires { pulley.center_m; }) {
          if (k > 0) move_with(robot, pulley, path[k - 1]);
          if (k + 1 < path.size()) move_with(robot, pulley, path[k + 1]);
          pulley.radius_m *= 1 + relative;
        }
      };
      std::visit(widen_here, path[k]);
    }
  }
  void move_with(const auto& robot, const auto& pulley, auto& neighbour) const {
    const auto move = [&](auto& guide) {
      if constexpr (requires { guide.at_m; }) {
        auto center = pulley.center_m;
        if (guide.body != pulley.body) {
          if (!turns_about(robot, pulley, guide.body)) return;
          center = {0, 0, 0};
        }
        const double distance_m = std::hypot(guide.at_m[0] - center[0], guide.at_m[1] - center[1],
                                             guide.at_m[2] - center[2]);
        if (distance_m > guide_radii * pulley.radius_m) return;
        for (std::size_t i = 0; i < 3; ++i)
          guide.at_m[i] = center[i] + (1 + relative) * (guide.at_m[i] - center[i]);
      }
    };
    std::visit(move, neighbour);
  }
  static bool turns_about(const auto& robot, const auto& pulley, const auto& body) {
    for (const auto& part : robot.skeletons)
      for (const auto& joint : part.joints)
        if (joint.child == body && joint.parent == pulley.body && joint.at_m == pulley.center_m)
          return true;
    return false;
  }
};

}  // namespace sim::effects

#pragma once
#include <cmath>

#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// The base is tilted, so the direction of gravity changes.
///
///   g' = R_x(−α) R_y(−β) g,   α, β: rotation of the base about x and y
///
/// Source: floors are seldom level to within one degree.
struct BaseTilt {
  static constexpr About about{"skeleton_base_tilt", Stage::skeleton, Seat::robot,
                               "static postures over the whole range"};

  double about_x_rad = 0, about_y_rad = 0;  // α, β

  void visit(auto& v) {
    v("about_x_rad", about_x_rad, Bounds{-0.6, 0.6});
    v("about_y_rad", about_y_rad, Bounds{-0.6, 0.6});
  }
  void change_robot(auto& robot, const auto&) const {
    for (auto& part : robot.skeletons) {
      if (!part.gravity_m_per_s2) continue;
      auto& [x, y, z] = *part.gravity_m_per_s2;
      turn(z, x, -about_y_rad);
      turn(y, z, -about_x_rad);
    }
  }

 private:
  /// Rotates the plane vector (a, b) by an angle from a to b.
  static void turn(double& a, double& b, double angle) {
    const double c = std::cos(angle), s = std::sin(angle), old_a = a;
    a = c * old_a - s * b, b = s * old_a + c * b;
  }
};

}  // namespace sim::effects

#pragma once
#include <cmath>

#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// The line rubs on what it is led around: the spindle feels more than the far end while it winds
/// up, less while it lets out.
///
///   F_motor = F exp((µ φ + p) tanh(v / v₀))    φ the path's total bend, v the line's speed
///
/// p: µφ of a post on its way that robot.xml does not show. v₀ smooths sgn(v): below it the line creeps where a real one would stick.
/// Source: Euler 1769; Eytelwein 1808; Kaneko et al. 1991 for tendons.
struct RoutingCapstan {
  static constexpr About about{"routing_capstan", Stage::routing, Seat::actuator,
                               "motion both ways under load, at several bends"};

  double friction = 0;               // µ
  double post = 0;                   // p
  double slip_speed_m_per_s = 5e-4;  // v₀

  void visit(auto& v) {
    v("friction", friction, Bounds{0, 0.6});
    v("post", post, Bounds{0, 0.6});
    v.shape("slip_speed_m_per_s", slip_speed_m_per_s, Bounds{1e-5, 0.05});
  }
  double motor_side_N(double far_N, const ChainSample& s) const {
    const double way = std::tanh(s.line_speed_m_per_s / slip_speed_m_per_s);
    return far_N * std::exp((friction * s.wrap_rad + post) * way);
  }
};

}  // namespace sim::effects

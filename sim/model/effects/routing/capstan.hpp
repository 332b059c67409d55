#pragma once
#include <cmath>

#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// Friction of the line on guides and pulleys: the tension at the spindle is larger than at the distal
/// end while winding up, and smaller while unwinding.
///
///   F_motor = F exp((µ φ + p) tanh(v / v₀))    φ total bend of the path, v line speed
///
/// p: µφ of a post in the path that robot.xml does not contain. v₀ smooths sgn(v): below v₀ the line
/// creeps, whereas a real line would stick.
/// Source: Euler 1769; Eytelwein 1808; Kaneko et al. 1991 for tendons.
struct RoutingCapstan {
  static constexpr About about{"routing_capstan", Stage::routing, Seat::actuator,
                               "motion in both directions under load, at several bend angles"};

  double friction = 0;               // µ
  double post = 0;                   // p
  double slip_speed_m_per_s = 5e-4;  // v₀

  void visit(auto& v) {
    v("friction", friction, Bounds{0, 0.6});
    v("post", post, Bounds{0, 0.6});
    v.shape("slip_speed_m_per_s", slip_speed_m_per_s, Bounds{1e-5, 0.05});
  }
  double motor_side_N(double far_N, const ChainSample& s) const {
    const double direction = std::tanh(s.line_speed_m_per_s / slip_speed_m_per_s);
    return far_N * std::exp((friction * s.wrap_rad + post) * direction);
  }
};

}  // namespace sim::effects

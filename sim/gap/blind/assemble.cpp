// An actuator of a blind robot: nominal constants with hidden effects.
#include <algorithm>
#include <cmath>

#include "sim/gap/blind/plant.hpp"

namespace sim::blind {
namespace {

/// The tendon with changed pulley radii, and the guides and attachment that move with them.
erp::Tendon changed_tendon(erp::Tendon tendon, const ChainEffects& q, const erp::Robot& robot) {
  const auto stretch_from = [](erp::Vec3& p, const erp::Vec3& from, double factor) {
    for (std::size_t i = 0; i < 3; ++i) p[i] = from[i] + factor * (p[i] - from[i]);
  };
  const auto far = [](const erp::Vec3& a, const erp::Vec3& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
  };
  auto& path = tendon.path;
  for (std::size_t k = 0; k < path.size() && q.pulley_radius != 0; ++k) {
    auto* pulley = std::get_if<erp::Pulley>(&path[k]);
    if (!pulley) continue;
    for (const std::size_t n : {k - 1, k + 1}) {
      auto* guide = n < path.size() ? std::get_if<erp::Attach>(&path[n]) : nullptr;
      if (!guide) continue;
      erp::Vec3 center = pulley->center_m;
      bool with = guide->body == pulley->body;
      for (const erp::Joint& joint : robot.joints())
        if (joint.child == guide->body && joint.parent == pulley->body &&
            joint.at_m == pulley->center_m)
          center = {0, 0, 0}, with = true;
      if (with && far(guide->at_m, center) < 1.1 * pulley->radius_m)
        stretch_from(guide->at_m, center, 1 + q.pulley_radius);
    }
    pulley->radius_m *= 1 + q.pulley_radius;
  }
  if (auto* end = std::get_if<erp::Attach>(&path.back()); end && q.attachment_shift_m != 0)
    stretch_from(end->at_m, {0, 0, 0}, 1 + q.attachment_shift_m / far(end->at_m, {0, 0, 0}));
  return tendon;
}

}  // namespace

Plant::Chain Plant::chain_of(const erp::Robot& nominal, std::size_t a, const ChainEffects& q) {
  const erp::Actuator& actuator = nominal.actuators[a];
  const erp::Tendon& tendon = actuator.tendon;
  const Routing routing(changed_tendon(tendon, q, nominal), tree_.names);
  Chain k{.motor = nominal.motor_of(actuator),
          .q = q,
          .routing = routing,
          .levers = levers_of(routing, model_),
          .shape = routing.solve(model_.poses()),
          .row = {}};
  k.motor.resistance_ohm *= 1 + q.resistance, k.motor.inductance_H *= 1 + q.inductance;
  k.motor.torque_Nm_per_A *= 1 + q.torque_constant,
      k.motor.back_emf_V_s_per_rad *= 1 + q.torque_constant;
  k.motor.rotor_inertia_kg_m2 *= 1 + q.rotor;
  k.radius_m = actuator.spindle.radius_m * (1 + q.radius);
  k.spring = tendon.stiffness_N_per_m * (1 + q.spring);
  k.cubic = tendon.cubic_N_per_m3 * (1 + q.spring) + q.cubic;
  k.damping = std::max(0.0, tendon.damping_N_s_per_m + q.damping);
  const auto& line = tendon.line_stiffness_N_per_m;
  k.line = line ? 1 / *line : 0;
  k.two_masses = q.backlash_rad > 0 || q.shaft_rad_per_Nm > 0;
  k.start_m = k.shape.length_m;
  k.rest_m = k.start_m - stretch_at(k, tendon.pretension_N) - q.line_m_per_N * tendon.pretension_N;
  if (q.shaft_rad_per_Nm >
      0)  // the motor side is at zero, the far end of the shaft is twisted back
    k.rest_m -= k.radius_m * k.radius_m * q.shaft_rad_per_Nm * tendon.pretension_N;
  return k;
}

/// Stretch of spring and line in series under a force, by bisection.
double Plant::stretch_at(const Chain& k, double pull_N) const {
  constexpr int enough = 60;
  double low = 0, high = pull_N * (1 / k.spring + k.line);
  while (spring_N(k, high) < pull_N) high *= 2;
  for (int n = 0; n < enough; ++n) {
    const double middle = (low + high) / 2;
    (spring_N(k, middle) < pull_N ? low : high) = middle;
  }
  return high;
}

}  // namespace sim::blind

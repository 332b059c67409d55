// Constants of an actuator channel of a blind robot: nominal values with hidden effects.
#include <algorithm>
#include <cmath>

#include "sim/gap/blind/plant.hpp"

namespace sim::blind {
namespace {

/// The tendon with changed radii of its pulleys. Guides on a changed pulley and a shifted
/// attachment are moved.
erp::Tendon changed_tendon(erp::Tendon tendon, const ChannelEffects& q, const erp::Robot& robot) {
  const auto scale_from = [](erp::Vec3& p, const erp::Vec3& from, double factor) {
    for (std::size_t i = 0; i < 3; ++i) p[i] = from[i] + factor * (p[i] - from[i]);
  };
  const auto distance_m = [](const erp::Vec3& a, const erp::Vec3& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
  };
  auto& path = tendon.path;
  constexpr double on_pulley_radii = 1.1;  // a guide within this distance is on the pulley; chosen
  for (std::size_t k = 0; k < path.size() && q.pulley_radius != 0; ++k) {
    auto* pulley = std::get_if<erp::Pulley>(&path[k]);
    if (!pulley) continue;
    for (const std::size_t n : {k - 1, k + 1}) {
      auto* guide = n < path.size() ? std::get_if<erp::Attach>(&path[n]) : nullptr;
      if (!guide) continue;
      erp::Vec3 center = pulley->center_m;
      bool is_same_body = guide->body == pulley->body;
      for (const erp::Joint& joint : robot.joints())
        if (joint.child == guide->body && joint.parent == pulley->body &&
            joint.at_m == pulley->center_m)
          center = {0, 0, 0}, is_same_body = true;
      if (is_same_body && distance_m(guide->at_m, center) < on_pulley_radii * pulley->radius_m)
        scale_from(guide->at_m, center, 1 + q.pulley_radius);
    }
    pulley->radius_m *= 1 + q.pulley_radius;
  }
  if (auto* end = std::get_if<erp::Attach>(&path.back()); end && q.attachment_shift_m != 0)
    scale_from(end->at_m, {0, 0, 0}, 1 + q.attachment_shift_m / distance_m(end->at_m, {0, 0, 0}));
  return tendon;
}

}  // namespace

Plant::Channel Plant::channel_of(const erp::Robot& nominal, std::size_t a,
                                 const ChannelEffects& q) {
  const erp::Actuator& actuator = nominal.actuators[a];
  const erp::Tendon& tendon = actuator.tendon;
  const Routing routing(changed_tendon(tendon, q, nominal), tree_.names);
  Channel k{.motor = nominal.motor_of(actuator),
            .q = q,
            .routing = routing,
            .levers = levers_of(routing, model_),
            .shape = routing.solve(model_.poses()),
            .moment_arms = {}};
  k.motor.resistance_ohm *= 1 + q.resistance, k.motor.inductance_H *= 1 + q.inductance;
  k.motor.torque_Nm_per_A *= 1 + q.torque_constant,
      k.motor.back_emf_V_s_per_rad *= 1 + q.torque_constant;
  k.motor.rotor_inertia_kg_m2 *= 1 + q.rotor;
  k.radius_m = actuator.spindle.radius_m * (1 + q.radius);
  k.spring_N_per_m = tendon.stiffness_N_per_m * (1 + q.spring);
  k.cubic_N_per_m3 = tendon.cubic_N_per_m3 * (1 + q.spring) + q.cubic;
  k.damping_N_s_per_m = std::max(0.0, tendon.damping_N_s_per_m + q.damping);
  const auto& line = tendon.line_stiffness_N_per_m;
  k.line_m_per_N = line ? 1 / *line : 0;
  k.two_masses = q.backlash_rad > 0 || q.shaft_rad_per_Nm > 0;
  k.initial_length_m = k.shape.length_m;
  k.rest_length_m = k.initial_length_m - stretch_at(k, tendon.pretension_N) -
                    q.line_m_per_N * tendon.pretension_N;
  // Initially the motor side is at zero, and the spindle end of a compliant shaft is twisted back.
  if (q.shaft_rad_per_Nm > 0)
    k.rest_length_m -= k.radius_m * k.radius_m * q.shaft_rad_per_Nm * tendon.pretension_N;
  return k;
}

/// Stretch of spring and line in series under a force, by bisection.
double Plant::stretch_at(const Channel& k, double force_N) const {
  constexpr int bisections = 60;  // to the precision of double
  double low = 0, high = force_N * (1 / k.spring_N_per_m + k.line_m_per_N);
  while (spring_N(k, high) < force_N) high *= 2;
  for (int n = 0; n < bisections; ++n) {
    const double middle = (low + high) / 2;
    (spring_N(k, middle) < force_N ? low : high) = middle;
  }
  return high;
}

}  // namespace sim::blind

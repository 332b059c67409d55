// Motion of the bones of a blind robot: friction, springs and stops of its joints, H q̈ = τ − C −
// τ_G.
#include <algorithm>
#include <cmath>

#include "sim/gap/blind/plant.hpp"
#include "sim/gap/blind/state.hpp"

namespace sim::blind {
namespace {

namespace c = channel_state;
namespace j = joint_state;

// Chosen: small against the motion of a joint, resolved by the integrator's step.
constexpr double bristle_travel_rad = 2e-4, bristle_damping_s = 2e-3;
constexpr double max_deflection = 1.2;  // of a bristle with its damping; chosen
constexpr double stop_Nm_per_rad = 300, stop_Nm_s_per_rad = 1;  // chosen: stiff against tendons
constexpr double play_time_constant_s = 2e-4;  // at the ends of the play: twice the step

/// Friction torque of a joint about one axis with velocity v; speed: of all axes; ds: rate of the
/// bristle.
double friction(const erp::Joint& joint, const JointEffects& q, double speed, double v,
                double bristle, double& ds) {
  const double dry = std::max(0.0, joint.coulomb_Nm + q.dry_Nm) +
                     q.stribeck_Nm * std::exp(-speed / q.stribeck_rad_per_s);
  ds = (v - speed * bristle) / bristle_travel(bristle_travel_rad, speed);
  const double deflection =
      std::clamp(bristle + bristle_damping_s * ds, -max_deflection, max_deflection);
  return -std::max(0.0, joint.viscous_Nm_s_per_rad + q.viscous) * v - dry * deflection -
         q.drag * v * std::abs(v);
}

/// Torque of the spring and the stops of a hinge.
double spring_and_stops(const erp::Joint& joint, const JointEffects& q, double angle, double v) {
  double torque = -q.spring * (angle - q.rest_rad);
  const double over = angle - (joint.max_rad - q.early_max_rad);
  const double under = joint.min_rad + q.early_min_rad - angle;
  if (over > 0) torque -= std::max(0.0, stop_Nm_per_rad * over + stop_Nm_s_per_rad * v);
  if (under > 0) torque += std::max(0.0, stop_Nm_per_rad * under - stop_Nm_s_per_rad * v);
  return torque;
}

/// Play and low-pass of the sensor of a hinge.
void sense(const JointEffects& q, const double* s, double* ds) {
  const double offset = s[j::position] - s[j::bearing], half = q.play_rad / 2;
  ds[j::bearing] =
      (std::max(0.0, offset - half) + std::min(0.0, offset + half)) / play_time_constant_s;
  const double sensor_input = q.play_rad > 0 ? s[j::bearing] : s[j::position];
  ds[j::reading] = q.angle.lag_s > 0 ? (sensor_input - s[j::reading]) / q.angle.lag_s : 0;
}

/// q̇ = q ⊗ (0, ω)/2
void spin(const double* s, double* ds) {
  const double w = s[0], i = s[1], k = s[2], l = s[3];
  const double p = s[j::velocity], q = s[j::velocity + 1], r = s[j::velocity + 2];
  ds[0] = -(i * p + k * q + l * r) / 2, ds[1] = (w * p + k * r - l * q) / 2;
  ds[2] = (w * q + l * p - i * r) / 2, ds[3] = (w * r + i * q - k * p) / 2;
}

}  // namespace

void Plant::move_bones(const State& x, const Eigen::VectorXd& tendon_torque, double gust,
                       State& dx) {
  Eigen::VectorXd torque = tendon_torque;
  const std::size_t first_joint = channels_.size() * c::count;
  const auto at = [&](std::size_t n) { return first_joint + n * j::count; };
  const auto coordinates = [&](std::size_t n) {
    const int first = model_.first_of(static_cast<int>(n));
    return std::pair(first, first < 0 ? 0 : coordinates_of(joints_[n].type));
  };
  for (std::size_t n = 0; n < joints_.size(); ++n) {
    const auto [first, dofs] = coordinates(n);
    if (dofs == 0) continue;
    const JointEffects& q = joint_effects_[n];
    const double* s = &x[at(n)];
    double* ds = &dx[at(n)];
    double speed = 0;
    for (int d = 0; d < dofs; ++d) speed = std::hypot(speed, s[j::velocity + d]);
    for (int d = 0; d < dofs; ++d)
      torque[first + d] += friction(tree_.joints[n], q, speed, s[j::velocity + d],
                                    s[j::bristle + d], ds[j::bristle + d]);
    torque[first] += gust * q.random_Nm;
    if (dofs != 1) continue;
    torque[first] += spring_and_stops(tree_.joints[n], q, s[j::position], s[j::velocity]);
    sense(q, s, ds);
  }
  model_.bias(bias_);
  model_.inertia(inertia_);
  const Eigen::VectorXd a = inertia_.llt().solve(torque - bias_);
  for (std::size_t n = 0; n < joints_.size(); ++n) {
    const auto [first, dofs] = coordinates(n);
    double* ds = &dx[at(n)];
    for (int d = 0; d < dofs; ++d) ds[j::velocity + d] = a[first + d];
    if (dofs == 1) ds[j::position] = x[at(n) + j::velocity];
    if (dofs == 3) spin(&x[at(n)], ds);
  }
}

}  // namespace sim::blind

#include "sim/blind/plant.hpp"

#include <algorithm>
#include <cmath>

#include "sim/blind/state.hpp"

namespace sim::blind {
namespace {

namespace c = chain_state;
namespace j = joint_state;

constexpr double usual_step_s = 1e-4, two_mass_step_s = 4e-5;
constexpr double joint_reach_rad = 2e-4, joint_settles_s = 2e-3;
constexpr double stop_Nm_per_rad = 300, stop_Nm_s_per_rad = 1;
constexpr double loose_s = 1e-3;  // how fast a loose shaft is taken along

Vec3 gravity_of(const erp::Robot& robot) {
  const auto g = robot.gravity_m_per_s2();
  return {g[0], g[1], g[2]};
}

/// Guides and ends that other radii or a shifted end move.
erp::Tendon bent(erp::Tendon tendon, const ChainQuirks& q, const erp::Robot& robot) {
  const auto stretch_from = [](erp::Vec3& p, const erp::Vec3& from, double factor) {
    for (std::size_t i = 0; i < 3; ++i) p[i] = from[i] + factor * (p[i] - from[i]);
  };
  const auto far = [](const erp::Vec3& a, const erp::Vec3& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
  };
  auto& path = tendon.path;
  for (std::size_t k = 0; k < path.size() && q.pulley != 0; ++k) {
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
        stretch_from(guide->at_m, center, 1 + q.pulley);
    }
    pulley->radius_m *= 1 + q.pulley;
  }
  if (auto* end = std::get_if<erp::Attach>(&path.back()); end && q.shift_m != 0)
    stretch_from(end->at_m, {0, 0, 0}, 1 + q.shift_m / far(end->at_m, {0, 0, 0}));
  return tendon;
}

}  // namespace

Plant::Plant(const erp::Robot& nominal, const Quirks& quirks)
    : tree_(changed(nominal, quirks)),
      model_(tree_, gravity_of(changed(nominal, quirks))),
      joint_quirks_(quirks.joints),
      most_step_s_(usual_step_s) {
  joint_quirks_.resize(tree_.joints.size());
  for (std::size_t k = 0; k < tree_.joints.size(); ++k)
    if (const auto& name = tree_.joints[k].name; name.ends_with("_bows"))
      joint_quirks_[k].spring =
          1 / quirks.bodies.at(name.substr(0, name.size() - 5)).bend_rad_per_Nm;
  for (const erp::Joint& joint : tree_.joints) joints_.push_back(start_of(joint));
  model_.place(joints_);
  for (std::size_t a = 0; a < nominal.actuators.size(); ++a) {
    const erp::Actuator& actuator = nominal.actuators[a];
    const ChainQuirks& q = quirks.chains[a];
    const Routing routing(bent(actuator.tendon, q, nominal), tree_.names);
    Chain k{nominal.motor_of(actuator),
            q,
            routing,
            levers_of(routing, model_),
            routing.solve(model_.poses()),
            0,
            0,
            0,
            0,
            0,
            0,
            0,
            false,
            {}};
    k.motor.resistance_ohm *= 1 + q.ohm, k.motor.inductance_H *= 1 + q.henry;
    k.motor.torque_Nm_per_A *= 1 + q.torque, k.motor.back_emf_V_s_per_rad *= 1 + q.torque;
    k.motor.rotor_inertia_kg_m2 *= 1 + q.rotor;
    k.radius_m = actuator.spindle.radius_m * (1 + q.radius);
    k.spring = actuator.tendon.stiffness_N_per_m * (1 + q.spring);
    k.cubic = actuator.tendon.cubic_N_per_m3 * (1 + q.spring) + q.cubic;
    k.damping = std::max(0.0, actuator.tendon.damping_N_s_per_m + q.damping);
    const auto& line = actuator.tendon.line_stiffness_N_per_m;
    k.line = (line ? 1 / *line : 0) + q.line_m_per_N;
    k.two_masses = q.play_rad > 0 || q.twist_rad_per_Nm > 0;
    k.start_m = k.shape.length_m;
    double stretch = actuator.tendon.pretension_N / k.spring;
    for (int n = 0; n < 60; ++n)
      stretch += (actuator.tendon.pretension_N - spring_N(k, stretch)) * (1 / k.spring + k.line);
    k.rest_m = k.start_m - stretch;
    if (q.twist_rad_per_Nm > 0)  // the shaft is where it booted, its far end is turned back
      k.rest_m -= k.radius_m * k.radius_m * q.twist_rad_per_Nm * actuator.tendon.pretension_N;
    most_step_s_ = std::min({most_step_s_, k.two_masses ? two_mass_step_s : usual_step_s,
                             0.9 * k.motor.inductance_H / k.motor.resistance_ohm});
    chains_.push_back(std::move(k));
  }
  x_.assign(chains_.size() * c::count + joints_.size() * j::count, 0.0);
  for (std::size_t a = 0; a < chains_.size(); ++a) {
    double* x = &x_[a * c::count];
    const double pretension_N = nominal.actuators[a].tendon.pretension_N;
    x[c::spindle] = -chains_[a].q.twist_rad_per_Nm * chains_[a].radius_m * pretension_N;
    x[c::flowed] = chains_[a].start_m - chains_[a].rest_m + chains_[a].radius_m * x[c::spindle];
    x[c::said_tension] = pretension_N;
    tension_N_.push_back(x[c::said_tension]);
  }
  for (std::size_t n = 0; n < joints_.size(); ++n) {
    double* x = &x_[chains_.size() * c::count + n * j::count];
    for (std::size_t i = 0; i < 4; ++i) x[j::position + i] = joints_[n].position[i];
    x[j::bearing] = x[j::said] = joints_[n].position[0];
  }
}

void Plant::read_joints(const State& x) {
  for (std::size_t n = 0; n < joints_.size(); ++n) {
    const double* s = &x[chains_.size() * c::count + n * j::count];
    JointReading& reading = joints_[n];
    double norm = 0;
    for (std::size_t i = 0; i < 4; ++i) reading.position[i] = s[i], norm += s[i] * s[i];
    if (reading.type == erp::JointType::spherical)
      for (double& p : reading.position) p /= std::sqrt(norm);
    for (std::size_t i = 0; i < 3; ++i) reading.velocity_rad_per_s[i] = s[j::velocity + i];
  }
  model_.place(joints_);
}

void Plant::derive(const State& x, std::span<const double> voltage_V, double gust, State& dx) {
  read_joints(x);
  Eigen::VectorXd torque = Eigen::VectorXd::Zero(model_.coordinates());
  for (std::size_t a = 0; a < chains_.size(); ++a) {
    Chain& k = chains_[a];
    k.routing.solve(model_.poses(), k.shape);
    length_gradient(k.shape, k.levers, model_, k.row);
    const double* s = &x[a * c::count];
    double* ds = &dx[a * c::count];
    const Line line = pull(k, s, k.row.dot(model_.velocity()), ds);
    turn(k, s, line, voltage_V[a], ds);
    lag(k, s, line, ds);
    tension_N_[a] = line.tension_N;
    torque -= line.tension_N * line.path_slope * k.row;
  }
  move_bones(x, torque, gust, dx);
}

void Plant::move_bones(const State& x, const Eigen::VectorXd& pulled, double gust, State& dx) {
  Eigen::VectorXd torque = pulled;
  const std::size_t first_joint = chains_.size() * c::count;
  for (std::size_t n = 0; n < joints_.size(); ++n) {
    const int first = model_.first_of(static_cast<int>(n));
    const int dofs = coordinates_of(joints_[n].type);
    if (first < 0 || dofs == 0) continue;
    const erp::Joint& joint = tree_.joints[n];
    const JointQuirks& q = joint_quirks_[n];
    const double* s = &x[first_joint + n * j::count];
    double* ds = &dx[first_joint + n * j::count];
    double speed = 0;
    for (int d = 0; d < dofs; ++d) speed = std::hypot(speed, s[j::velocity + d]);
    const double dry = std::max(0.0, joint.coulomb_Nm + q.dry_Nm) +
                       q.stribeck_Nm * std::exp(-speed / q.stribeck_rad_per_s);
    for (int d = 0; d < dofs; ++d) {
      const double v = s[j::velocity + d];
      double& rate = ds[j::bristle + d];
      rate = (v - speed * s[j::bristle + d]) / joint_reach_rad;
      const double rub = std::clamp(s[j::bristle + d] + joint_settles_s * rate, -1.2, 1.2);
      torque[first + d] -= std::max(0.0, joint.viscous_Nm_s_per_rad + q.viscous) * v + dry * rub +
                           q.drag * v * std::abs(v);
    }
    torque[first] += gust * q.gusts_Nm;
    if (dofs == 1) {
      const double angle = s[j::position], v = s[j::velocity];
      torque[first] -= q.spring * (angle - q.rest_rad);
      const double over = angle - (joint.max_rad - q.max_in_rad);
      const double under = joint.min_rad + q.min_in_rad - angle;
      if (over > 0) torque[first] -= std::max(0.0, stop_Nm_per_rad * over + stop_Nm_s_per_rad * v);
      if (under > 0)
        torque[first] += std::max(0.0, stop_Nm_per_rad * under - stop_Nm_s_per_rad * v);
      const double off = angle - s[j::bearing], half = q.loose_rad / 2;
      ds[j::bearing] = (std::max(0.0, off - half) + std::min(0.0, off + half)) / loose_s;
      const double seen = q.loose_rad > 0 ? s[j::bearing] : angle;
      ds[j::said] = q.angle.lag_s > 0 ? (seen - s[j::said]) / q.angle.lag_s : 0;
    }
  }
  model_.bias(bias_);
  model_.inertia(inertia_);
  const Eigen::VectorXd a = inertia_.llt().solve(torque - bias_);
  for (std::size_t n = 0; n < joints_.size(); ++n) {
    const int first = model_.first_of(static_cast<int>(n));
    const double* s = &x[first_joint + n * j::count];
    double* ds = &dx[first_joint + n * j::count];
    const int dofs = first < 0 ? 0 : coordinates_of(joints_[n].type);
    for (int d = 0; d < dofs; ++d) ds[j::velocity + d] = a[first + d];
    if (dofs == 1) ds[j::position] = s[j::velocity];
    if (dofs == 3) {  // q̇ = q ⊗ (0, ω)/2
      const double w = s[0], i = s[1], k = s[2], l = s[3];
      const double p = s[j::velocity], q = s[j::velocity + 1], r = s[j::velocity + 2];
      ds[0] = -(i * p + k * q + l * r) / 2, ds[1] = (w * p + k * r - l * q) / 2;
      ds[2] = (w * q + l * p - i * r) / 2, ds[3] = (w * r + i * q - k * p) / 2;
    }
  }
}

bool Plant::run(std::span<const double> voltage_V, double duration_s, double gust) {
  const int steps = static_cast<int>(std::ceil(duration_s / most_step_s_ - 1e-9));
  const double h = duration_s / steps;
  const std::size_t n = x_.size();
  State k1(n), k2(n), k3(n), k4(n), at(n);
  const auto reach = [&](const State& k, double by) {
    for (std::size_t i = 0; i < n; ++i) at[i] = x_[i] + by * k[i];
  };
  for (int s = 0; s < steps; ++s) {
    derive(x_, voltage_V, gust, k1);
    reach(k1, h / 2), derive(at, voltage_V, gust, k2);
    reach(k2, h / 2), derive(at, voltage_V, gust, k3);
    reach(k3, h), derive(at, voltage_V, gust, k4);
    for (std::size_t i = 0; i < n; ++i) x_[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
    time_s_ += h;
  }
  derive(x_, voltage_V, gust, k1);  // the tensions of now
  return std::ranges::all_of(x_, [](double v) { return std::isfinite(v); });
}

double Plant::shaft_rad(std::size_t a) const {
  return x_[a * c::count + (chains_[a].q.shaft.lag_s > 0 ? c::said_shaft : c::shaft)];
}
double Plant::current_A(std::size_t a) const {
  return x_[a * c::count + (chains_[a].q.current.lag_s > 0 ? c::said_current : c::current)];
}
double Plant::tension_N(std::size_t a) const {
  return chains_[a].q.tension.lag_s > 0 ? x_[a * c::count + c::said_tension] : tension_N_[a];
}
double Plant::angle_rad(std::size_t n) const {
  const double* x = &x_[chains_.size() * c::count + n * j::count];
  const JointQuirks& q = joint_quirks_[n];
  return q.angle.lag_s > 0 ? x[j::said] : q.loose_rad > 0 ? x[j::bearing] : x[j::position];
}
std::array<double, 4> Plant::quaternion(std::size_t n) const { return joints_[n].position; }

}  // namespace sim::blind

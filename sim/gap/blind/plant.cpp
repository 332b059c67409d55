#include "sim/gap/blind/plant.hpp"

#include <algorithm>
#include <cmath>

#include "sim/gap/blind/state.hpp"

namespace sim::blind {
namespace {

namespace c = channel_state;
namespace j = joint_state;

// Chosen: below the shortest time constants of the bristles and of the stiff gear teeth.
constexpr double usual_step_s = 1e-4, two_mass_step_s = 4e-5;
// The method of order four is stable up to 2.8 time constants. Chosen: one, with a margin.
constexpr double steps_per_electrical_time_constant = 0.9;

Vec3 gravity_of(const erp::Robot& robot) {
  const auto g = robot.gravity_m_per_s2();
  return {g[0], g[1], g[2]};
}

}  // namespace

Plant::Plant(const erp::Robot& nominal, const HiddenEffects& hidden_effects)
    : tree_(changed(nominal, hidden_effects)),
      model_(tree_, gravity_of(changed(nominal, hidden_effects))),
      joint_effects_(hidden_effects.joints),
      max_step_s_(usual_step_s) {
  joint_effects_.resize(tree_.joints.size());
  for (std::size_t k = 0; k < tree_.joints.size(); ++k)
    if (const auto& name = tree_.joints[k].name; name.ends_with("_bows"))
      joint_effects_[k].spring =
          1 / hidden_effects.bodies.at(name.substr(0, name.size() - 5)).bend_rad_per_Nm;
  for (const erp::Joint& joint : tree_.joints) joints_.push_back(initial_reading(joint));
  model_.place(joints_);
  for (std::size_t a = 0; a < nominal.actuators.size(); ++a)
    channels_.push_back(channel_of(nominal, a, hidden_effects.channels[a]));
  for (const Channel& k : channels_)
    max_step_s_ = std::min(
        {max_step_s_, k.two_masses ? two_mass_step_s : usual_step_s,
         steps_per_electrical_time_constant * k.motor.inductance_H / k.motor.resistance_ohm});
  set_initial_state(nominal);
}

/// Initial state: at rest, lines at their pretension.
void Plant::set_initial_state(const erp::Robot& nominal) {
  x_.assign(channels_.size() * c::count + joints_.size() * j::count, 0.0);
  for (std::size_t a = 0; a < channels_.size(); ++a) {
    double* x = &x_[a * c::count];
    const double pretension_N = nominal.actuators[a].tendon.pretension_N;
    x[c::spindle] = -channels_[a].q.shaft_rad_per_Nm * channels_[a].radius_m * pretension_N;
    x[c::inner] = stretch_at(channels_[a], pretension_N);
    x[c::crept] = channels_[a].initial_length_m - channels_[a].rest_length_m +
                  channels_[a].radius_m * x[c::spindle];
    x[c::reading_tension] = pretension_N;
    tension_N_.push_back(x[c::reading_tension]);
  }
  for (std::size_t n = 0; n < joints_.size(); ++n) {
    double* x = &x_[channels_.size() * c::count + n * j::count];
    for (std::size_t i = 0; i < 4; ++i) x[j::position + i] = joints_[n].position[i];
    x[j::bearing] = x[j::reading] = joints_[n].position[0];
  }
}

void Plant::read_joints(const State& x) {
  for (std::size_t n = 0; n < joints_.size(); ++n) {
    const double* s = &x[channels_.size() * c::count + n * j::count];
    JointReading& reading = joints_[n];
    double norm = 0;
    for (std::size_t i = 0; i < 4; ++i) reading.position[i] = s[i], norm += s[i] * s[i];
    if (reading.type == erp::JointType::spherical)
      for (double& p : reading.position) p /= std::sqrt(norm);
    for (std::size_t i = 0; i < 3; ++i) reading.velocity_rad_per_s[i] = s[j::velocity + i];
  }
  model_.place(joints_);
}

void Plant::derivative(const State& x, std::span<const double> voltage_V, double gust, State& dx) {
  read_joints(x);
  Eigen::VectorXd torque = Eigen::VectorXd::Zero(model_.coordinates());
  for (std::size_t a = 0; a < channels_.size(); ++a) {
    Channel& k = channels_[a];
    k.routing.solve(model_.poses(), k.shape);
    length_gradient(k.shape, k.levers, model_, k.moment_arms);
    const double* s = &x[a * c::count];
    double* ds = &dx[a * c::count];
    const Line line = pull_tendon(k, s, k.moment_arms.dot(model_.velocity()), ds);
    turn_motor(k, s, line, voltage_V[a], ds);
    filter_readings(k, s, line, ds);
    tension_N_[a] = line.tension_N;
    torque -= line.tension_N * line.path_slope * k.moment_arms;
  }
  move_bones(x, torque, gust, dx);
}

bool Plant::run(std::span<const double> voltage_V, double duration_s, double gust) {
  const int steps = static_cast<int>(std::ceil(duration_s / max_step_s_ - 1e-9));
  const double h = duration_s / steps;
  const std::size_t n = x_.size();
  State k1(n), k2(n), k3(n), k4(n), stage(n);
  const auto set_stage = [&](const State& k, double duration) {
    for (std::size_t i = 0; i < n; ++i) stage[i] = x_[i] + duration * k[i];
  };
  for (int s = 0; s < steps; ++s) {
    derivative(x_, voltage_V, gust, k1);
    set_stage(k1, h / 2), derivative(stage, voltage_V, gust, k2);
    set_stage(k2, h / 2), derivative(stage, voltage_V, gust, k3);
    set_stage(k3, h), derivative(stage, voltage_V, gust, k4);
    for (std::size_t i = 0; i < n; ++i) x_[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
    time_s_ += h;
  }
  derivative(x_, voltage_V, gust, k1);  // updates tension_N_
  return std::ranges::all_of(x_, [](double v) { return std::isfinite(v); });
}

double Plant::shaft_rad(std::size_t a) const {
  return x_[a * c::count + (channels_[a].q.shaft.lag_s > 0 ? c::reading_shaft : c::shaft)];
}
double Plant::current_A(std::size_t a) const {
  return x_[a * c::count + (channels_[a].q.current.lag_s > 0 ? c::reading_current : c::current)];
}
double Plant::tension_N(std::size_t a) const {
  return channels_[a].q.tension.lag_s > 0 ? x_[a * c::count + c::reading_tension] : tension_N_[a];
}
double Plant::angle_rad(std::size_t n) const {
  const double* x = &x_[channels_.size() * c::count + n * j::count];
  const JointEffects& q = joint_effects_[n];
  return q.angle.lag_s > 0 ? x[j::reading] : q.play_rad > 0 ? x[j::bearing] : x[j::position];
}
std::array<double, 4> Plant::quaternion(std::size_t n) const { return joints_[n].position; }

}  // namespace sim::blind

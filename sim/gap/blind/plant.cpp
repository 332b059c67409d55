#include "sim/gap/blind/plant.hpp"

#include <algorithm>
#include <cmath>

#include "sim/gap/blind/state.hpp"

namespace sim::blind {
namespace {

namespace c = chain_state;
namespace j = joint_state;

constexpr double usual_step_s = 1e-4, two_mass_step_s = 4e-5;

Vec3 gravity_of(const erp::Robot& robot) {
  const auto g = robot.gravity_m_per_s2();
  return {g[0], g[1], g[2]};
}

}  // namespace

Plant::Plant(const erp::Robot& nominal, const HiddenEffects& hidden_effects)
    : tree_(changed(nominal, hidden_effects)),
      model_(tree_, gravity_of(changed(nominal, hidden_effects))),
      joint_effects_(hidden_effects.joints),
      most_step_s_(usual_step_s) {
  joint_effects_.resize(tree_.joints.size());
  for (std::size_t k = 0; k < tree_.joints.size(); ++k)
    if (const auto& name = tree_.joints[k].name; name.ends_with("_bows"))
      joint_effects_[k].spring =
          1 / hidden_effects.bodies.at(name.substr(0, name.size() - 5)).bend_rad_per_Nm;
  for (const erp::Joint& joint : tree_.joints) joints_.push_back(initial_reading(joint));
  model_.place(joints_);
  for (std::size_t a = 0; a < nominal.actuators.size(); ++a)
    chains_.push_back(chain_of(nominal, a, hidden_effects.chains[a]));
  for (const Chain& k : chains_)
    most_step_s_ = std::min({most_step_s_, k.two_masses ? two_mass_step_s : usual_step_s,
                             0.9 * k.motor.inductance_H / k.motor.resistance_ohm});
  start(nominal);
}

/// Initial state: at rest, lines at their pretension.
void Plant::start(const erp::Robot& nominal) {
  x_.assign(chains_.size() * c::count + joints_.size() * j::count, 0.0);
  for (std::size_t a = 0; a < chains_.size(); ++a) {
    double* x = &x_[a * c::count];
    const double pretension_N = nominal.actuators[a].tendon.pretension_N;
    x[c::spindle] = -chains_[a].q.shaft_rad_per_Nm * chains_[a].radius_m * pretension_N;
    x[c::inner] = stretch_at(chains_[a], pretension_N);
    x[c::crept] = chains_[a].start_m - chains_[a].rest_m + chains_[a].radius_m * x[c::spindle];
    x[c::reading_tension] = pretension_N;
    tension_N_.push_back(x[c::reading_tension]);
  }
  for (std::size_t n = 0; n < joints_.size(); ++n) {
    double* x = &x_[chains_.size() * c::count + n * j::count];
    for (std::size_t i = 0; i < 4; ++i) x[j::position + i] = joints_[n].position[i];
    x[j::bearing] = x[j::reading] = joints_[n].position[0];
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
  derive(x_, voltage_V, gust, k1);  // updates the tensions
  return std::ranges::all_of(x_, [](double v) { return std::isfinite(v); });
}

double Plant::shaft_rad(std::size_t a) const {
  return x_[a * c::count + (chains_[a].q.shaft.lag_s > 0 ? c::reading_shaft : c::shaft)];
}
double Plant::current_A(std::size_t a) const {
  return x_[a * c::count + (chains_[a].q.current.lag_s > 0 ? c::reading_current : c::current)];
}
double Plant::tension_N(std::size_t a) const {
  return chains_[a].q.tension.lag_s > 0 ? x_[a * c::count + c::reading_tension] : tension_N_[a];
}
double Plant::angle_rad(std::size_t n) const {
  const double* x = &x_[chains_.size() * c::count + n * j::count];
  const JointEffects& q = joint_effects_[n];
  return q.angle.lag_s > 0 ? x[j::reading] : q.loose_rad > 0 ? x[j::bearing] : x[j::position];
}
std::array<double, 4> Plant::quaternion(std::size_t n) const { return joints_[n].position; }

}  // namespace sim::blind

#include "components/puller_follower/puller_follower.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace control {
namespace {

constexpr double creeping_rad_per_s = 0.02;  // chosen: below, Coulomb friction is taken as viscous

}  // namespace

PullerFollower::PullerFollower(const Params& params, const erp::Robot& robot)
    : params_(params),
      robot_(robot),
      names_(robot),
      model_(robot),
      tendons_{tendon_of(robot, true), tendon_of(robot, false)},
      now_(names_.size()),
      wanted_(names_.size()),
      inertia_(1, 1),
      bias_(1) {
  if (params_.high_N < params_.low_N)
    throw std::invalid_argument("high_N is the reference tension at a change of roles: give " +
                                std::to_string(params_.low_N) + " or more");
}

/// The tendon that turns the joint towards positive angles, or the other.
PullerFollower::Tendon PullerFollower::tendon_of(const erp::Robot& robot, bool positive) const {
  const auto& l = model_.jacobian();
  if (model_.coordinates() == 1 && robot.actuators.size() == 2 && l(0, 0) * l(1, 0) < 0) {
    const std::size_t a = (l(0, 0) < 0) == positive ? 0 : 1;  // it turns where it gets shorter
    const erp::Actuator& actuator = robot.actuators[a];
    return {a, TensionLinearisation(
                   sim::MotorInverse(robot.motor_of(actuator), actuator.spindle.radius_m),
                   sim::Spring::of(actuator.tendon), params_.tension_per_s)};
  }
  throw std::invalid_argument("robot \"" + robot.name +
                              "\" is no single hinge with two antagonists; for others there is "
                              "computed_force");
}

std::optional<erp::ActuatorCommand> PullerFollower::step(
    const erp::SensorFrame& frame, double dt_s, const node::Latest<erp::JointState>& state,
    const node::Latest<erp::JointTarget>& target) {
  const bool heard = hear(frame, dt_s);
  const bool known = heard && state && state.age_s <= params_.stale_s &&
                     names_.read(state.message, now_) && target &&
                     target.age_s <= params_.stale_s && names_.read(target.message, wanted_);
  const bool begins = !std::exchange(driving_, known);
  if (!known) return std::nullopt;
  if (begins) integral_rad_s_ = 0;
  model_.place(now_);
  const double wanted_Nm = torque_Nm(dt_s);
  if (begins) torque_ = {wanted_Nm}, raised_N_ = params_.low_N, reference_ = {raised_N_};
  torque_.follow(wanted_Nm, dt_s, params_.smooth_s);
  const ReferenceTension raised{params_.low_N, params_.high_N, params_.width_Nm, params_.lead_s};
  const double most_N = params_.raise_N_per_s * dt_s;
  raised_N_ += std::clamp(raised.of(torque_.value, torque_.rate) - raised_N_, -most_N, most_N);
  reference_.follow(raised_N_, dt_s, params_.smooth_s);
  return command(frame);
}

bool PullerFollower::hear(const erp::SensorFrame& frame, double dt_s) {
  constexpr auto needed = erp::valid::shaft | erp::valid::tension;
  for (Tendon& tendon : tendons_) {
    const auto& name = robot_.actuators[tendon.actuator].name;
    const auto said = erp::samples(frame.actuators);
    const auto found = std::ranges::find_if(said, [&](const auto& s) { return name == s.name; });
    const bool valid = found != said.end() && (found->valid & needed) == needed;
    if (valid) {
      const bool moves = tendon.seen && dt_s > 0;
      tendon.speed_rad_per_s = moves ? (found->shaft_rad - tendon.shaft_rad) / dt_s : 0;
      tendon.shaft_rad = found->shaft_rad;
      tendon.tension_N = found->tension_N;
    }
    tendon.seen = valid;
  }
  return tendons_[0].seen && tendons_[1].seen;
}

/// The first step; friction is that of the wanted motion.
double PullerFollower::torque_Nm(double dt_s) {
  const auto at = static_cast<std::size_t>(
      std::ranges::find(names_.list(), erp::JointType::revolute, &erp::Joint::type) -
      names_.list().begin());
  const erp::Joint& joint = names_.list()[at];
  const sim::JointReading& now = now_[at];
  const sim::JointMotion& wanted = wanted_[at];
  const double e = wanted.now.position[0] - now.position[0];
  const double v_d = wanted.now.velocity_rad_per_s[0];
  integral_rad_s_ =
      std::clamp(integral_rad_s_ + dt_s * e, -params_.integral_rad_s, params_.integral_rad_s);
  acceleration_rad_per_s2_ = wanted.acceleration_rad_per_s2[0] +
                             params_.kd_per_s * (v_d - now.velocity_rad_per_s[0]) +
                             params_.kp_per_s2 * e + params_.ki_per_s3 * integral_rad_s_;
  model_.skeleton().inertia(inertia_);
  model_.skeleton().bias(bias_);
  const double friction =
      joint.viscous_Nm_s_per_rad + joint.coulomb_Nm / std::max(std::abs(v_d), creeping_rad_per_s);
  return inertia_(0, 0) * acceleration_rad_per_s2_ + bias_[0] + params_.friction * friction * v_d;
}

/// The second step.
erp::ActuatorCommand PullerFollower::command(const erp::SensorFrame&) {
  erp::ActuatorCommand command;
  const double speed = model_.skeleton().velocity()[0];
  Pair pair;
  for (std::size_t k = 0; k < 2; ++k)
    pair.arm_m[k] = std::abs(model_.jacobian()(static_cast<Eigen::Index>(tendons_[k].actuator), 0));
  const auto tension_N = pair.tensions_N(torque_.value, reference_.value);
  for (std::size_t k = 0; k < 2; ++k) {
    Tendon& t = tendons_[k];
    const double l = model_.jacobian()(static_cast<Eigen::Index>(t.actuator), 0);
    const bool pulls = pair.positive_pulls(torque_.value) == (k == 0);
    const double share = pulls ? (k == 0 ? 1 : -1) / pair.arm_m[k] : 0;  // dF_d/dτ
    const TensionLinearisation::Wanted wanted{
        tension_N[k], reference_.rate + share * torque_.rate,
        reference_.acceleration + share * torque_.acceleration};
    const double asked_V = t.law.voltage_V(
        {t.tension_N, t.speed_rad_per_s, l * speed, l * acceleration_rad_per_s2_}, wanted);
    const double supply_V = robot_.motor_of(robot_.actuators[t.actuator]).supply_V;
    erp::ActuatorReference reference{};
    erp::assign(reference.name, robot_.actuators[t.actuator].name);
    reference.mode = static_cast<std::uint8_t>(erp::Mode::voltage);
    reference.reference = std::clamp(asked_V, -supply_V, supply_V);
    erp::append(command.actuators, reference);
  }
  return command;
}

/// Two first-order lags in a row: value, and its first and second derivative.
void PullerFollower::Smooth::follow(double to, double dt_s, double smooth_s) {
  // ẍ = (to − x) / T² − 2 ẋ / T, implicitly
  const double T = smooth_s, h = dt_s;
  acceleration = ((to - value) / (T * T) - 2 * rate / T - h * rate / (T * T)) /
                 (1 + 2 * h / T + h * h / (T * T));
  rate += h * acceleration;
  value += h * rate;
}

}  // namespace control

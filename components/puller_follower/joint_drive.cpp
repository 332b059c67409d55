#include "components/puller_follower/joint_drive.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace control {
namespace {

// The values of the plant, which then takes up the slack.
constexpr double slack_N = 0.5, slack_limit_s = 0.016;
constexpr double lever_m = 1e-4;  // chosen: below, a tendon runs through the joint's axis

/// The actuators that turn a hinge, the one towards positive angles first.
std::array<std::size_t, 2> antagonists(const erp::Robot& robot, const sim::Musculoskeletal& model,
                                       const sim::loop_shaping::Hinge& hinge) {
  const auto& l = model.jacobian();
  std::vector<std::size_t> found;
  for (std::size_t a = 0; a < robot.actuators.size(); ++a) {
    const auto row = l.row(static_cast<Eigen::Index>(a));
    if (std::abs(row[hinge.coordinate]) < lever_m) continue;
    if ((row.array().abs() >= lever_m).count() > 1)
      throw std::invalid_argument("actuator \"" + robot.actuators[a].name +
                                  "\" turns more than one joint; puller-follower control "
                                  "needs one joint per muscle; use computed_force");
    found.push_back(a);
  }
  const auto lever = [&](std::size_t k) {
    return l(static_cast<Eigen::Index>(found[k]), hinge.coordinate);
  };
  if (found.size() != 2 || lever(0) * lever(1) > 0)
    throw std::invalid_argument("joint \"" + hinge.name + "\" of robot \"" + robot.name +
                                "\" needs exactly two antagonists; use computed_force");
  if (lever(0) > 0) std::swap(found[0], found[1]);  // a tendon turns the joint so that it shortens
  return {found[0], found[1]};
}

void add(const std::string& name, erp::Mode mode, double desired, erp::ActuatorCommand& message) {
  erp::ActuatorReference reference{};
  erp::assign(reference.name, name);
  reference.mode = static_cast<std::uint8_t>(mode);
  reference.reference = desired;
  erp::append(message.actuators, reference);
}

}  // namespace

JointDrive::Tendon JointDrive::tendon_of(const erp::Robot& robot, std::size_t a) const {
  const erp::Actuator& actuator = robot.actuators[a];
  const erp::MotorType& motor = robot.motor_of(actuator);
  return {a, actuator.name, motor.supply_V, actuator.max_tension_N,
          TensionLinearisation(sim::MotorInverse(motor, actuator.spindle.radius_m),
                               sim::Spring::of(actuator.tendon), params_.tension_per_s)};
}

JointDrive::JointDrive(const erp::Robot& robot, const sim::Musculoskeletal& model,
                       const sim::loop_shaping::Hinge& hinge, const DriveParams& params)
    : params_(params),
      coordinate_(hinge.coordinate),
      tendons_{tendon_of(robot, antagonists(robot, model, hinge)[0]),
               tendon_of(robot, antagonists(robot, model, hinge)[1])} {}

bool JointDrive::read_sensors(const erp::SensorFrame& frame, double dt_s) {
  constexpr auto needed = erp::valid::shaft | erp::valid::tension;
  for (Tendon& tendon : tendons_) {
    const auto samples = erp::samples(frame.actuators);
    const auto found =
        std::ranges::find_if(samples, [&](const auto& s) { return tendon.name == s.name; });
    const bool valid = found != samples.end() && (found->valid & needed) == needed;
    if (valid) {
      const bool moves = tendon.seen && dt_s > 0;
      tendon.speed_rad_per_s = moves ? (found->shaft_rad - tendon.shaft_rad) / dt_s : 0;
      tendon.shaft_rad = found->shaft_rad;
      tendon.tension_N = found->tension_N;
      tendon.line_m = found->line_m;
      tendon.slack_s = tendon.tension_N < slack_N ? tendon.slack_s + dt_s : 0;
    }
    tendon.seen = valid;
  }
  return tendons_[0].seen && tendons_[1].seen;
}

bool JointDrive::is_slack() const {
  return std::ranges::any_of(tendons_, [](const Tendon& t) { return t.slack_s > slack_limit_s; });
}

double JointDrive::torque_Nm(const sim::Musculoskeletal& model) const {
  double sum = 0;
  for (const Tendon& tendon : tendons_) sum -= lever_m(tendon, model) * tendon.tension_N;
  return sum;
}

void JointDrive::begin(double torque_Nm) {
  const double slacker_N = std::min(tendons_[0].tension_N, tendons_[1].tension_N);
  torque_ = {torque_Nm}, target_N_ = std::max(params_.low_N, slacker_N), reference_ = {target_N_};
}

void JointDrive::stop() {
  for (Tendon& tendon : tendons_) tendon.stopped_m = tendon.line_m;
  saturation_ = 0;
}

void JointDrive::brake(const sim::Musculoskeletal& model, erp::ActuatorCommand& message) const {
  const double speed = model.skeleton().velocity()[coordinate_];
  for (const Tendon& tendon : tendons_)
    add(tendon.name, erp::Mode::length,
        tendon.stopped_m - params_.brake_s * lever_m(tendon, model) * speed, message);
}

void JointDrive::follow(double torque_Nm, double dt_s) {
  torque_.follow(torque_Nm, dt_s, params_.smooth_s);
  const ReferenceTension raised{params_.low_N, params_.high_N, params_.width_Nm, params_.lead_s};
  const double most_N = params_.raise_N_per_s * dt_s;
  target_N_ += std::clamp(raised.of(torque_.value, torque_.rate) - target_N_, -most_N, most_N);
  reference_.follow(target_N_, dt_s, params_.raise_s);
}

void JointDrive::drive(double torque_Nm, double acceleration, const sim::Musculoskeletal& model,
                       double dt_s, erp::ActuatorCommand& message) {
  follow(torque_Nm, dt_s);
  const std::array levers_m{lever_m(tendons_[0], model), lever_m(tendons_[1], model)};
  const Pair pair{{std::abs(levers_m[0]), std::abs(levers_m[1])}};
  const auto tension_N = pair.tensions_N(torque_.value, reference_.value);
  const double speed = model.skeleton().velocity()[coordinate_];
  bool within = true;
  for (std::size_t k = 0; k < 2; ++k) {
    const bool pulls = pair.positive_pulls(torque_.value) == (k == 0);
    const double share = pulls ? (k == 0 ? 1 : -1) / pair.arm_m[k] : 0;  // dF_d/dτ
    within = command(k, tension_N[k], share, speed, levers_m[k], acceleration, message) && within;
  }
  saturation_ += dt_s / (1 + dt_s) * ((within ? 0 : 1) - saturation_);
}

bool JointDrive::command(std::size_t which, double tension_N, double share, double speed,
                         double lever_m, double acceleration, erp::ActuatorCommand& message) const {
  const Tendon& t = tendons_[which];
  const TensionLinearisation::Desired desired{
      std::min(tension_N, t.most_N), reference_.rate + share * torque_.rate,
      reference_.acceleration + share * torque_.acceleration};
  const double voltage_V = t.law.voltage_V(
      {t.tension_N, t.speed_rad_per_s, lever_m * speed, lever_m * acceleration}, desired);
  add(t.name, erp::Mode::voltage, std::clamp(voltage_V, -t.supply_V, t.supply_V), message);
  return std::abs(voltage_V) <= t.supply_V;
}

/// Two first-order lags in a row: value, and its first and second derivative.
void JointDrive::Smooth::follow(double to, double dt_s, double smooth_s) {
  // ẍ = (to − x) / T² − 2 ẋ / T, implicitly
  const double T = smooth_s, h = dt_s;
  acceleration = ((to - value) / (T * T) - 2 * rate / T - h * rate / (T * T)) /
                 (1 + 2 * h / T + h * h / (T * T));
  rate += h * acceleration;
  value += h * rate;
}

}  // namespace control

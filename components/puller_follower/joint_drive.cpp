#include "components/puller_follower/joint_drive.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace control {
namespace {

// Equal to the values of the plant, which takes up the slack.
constexpr double slack_N = 0.5, slack_limit_s = 0.016;
constexpr double min_lever_m = 1e-4;  // chosen: a tendon with less runs through the joint's axis

/// The actuators that turn a hinge, the one towards positive angles first.
std::array<std::size_t, 2> antagonists(const erp::Robot& robot, const sim::Musculoskeletal& model,
                                       const sim::loop_shaping::Hinge& hinge) {
  const auto& l = model.jacobian();
  std::vector<std::size_t> pair;
  for (std::size_t a = 0; a < robot.actuators.size(); ++a) {
    const auto row = l.row(static_cast<Eigen::Index>(a));
    if (std::abs(row[hinge.coordinate]) < min_lever_m) continue;
    if ((row.array().abs() >= min_lever_m).count() > 1)
      throw std::invalid_argument("actuator \"" + robot.actuators[a].name +
                                  "\" turns more than one joint; puller-follower control "
                                  "needs one joint per muscle; use computed_force");
    pair.push_back(a);
  }
  const auto lever = [&](std::size_t k) {
    return l(static_cast<Eigen::Index>(pair[k]), hinge.coordinate);
  };
  if (pair.size() != 2 || lever(0) * lever(1) > 0)
    throw std::invalid_argument("joint \"" + hinge.name + "\" of robot \"" + robot.name +
                                "\" needs exactly two antagonists; use computed_force");
  if (lever(0) > 0)
    std::swap(pair[0], pair[1]);  // a tendon pulls the joint to the side where the tendon shortens
  return {pair[0], pair[1]};
}

void append(const std::string& name, erp::Mode mode, double desired,
            erp::ActuatorCommand& message) {
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
    const auto sample =
        std::ranges::find_if(samples, [&](const auto& s) { return tendon.name == s.name; });
    const bool valid = sample != samples.end() && (sample->valid & needed) == needed;
    if (valid) {
      const bool has_previous = tendon.is_measured && dt_s > 0;
      tendon.speed_rad_per_s = has_previous ? (sample->shaft_rad - tendon.shaft_rad) / dt_s : 0;
      tendon.shaft_rad = sample->shaft_rad;
      tendon.tension_N = sample->tension_N;
      tendon.line_m = sample->line_m;
      tendon.slack_s = tendon.tension_N < slack_N ? tendon.slack_s + dt_s : 0;
    }
    tendon.is_measured = valid;
  }
  return tendons_[0].is_measured && tendons_[1].is_measured;
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
  const double smaller_N = std::min(tendons_[0].tension_N, tendons_[1].tension_N);
  torque_ = {torque_Nm}, target_N_ = std::max(params_.low_N, smaller_N), reference_ = {target_N_};
}

void JointDrive::stop() {
  for (Tendon& tendon : tendons_) tendon.brake_line_m = tendon.line_m;
  saturation_ = 0;
}

void JointDrive::brake(const sim::Musculoskeletal& model, erp::ActuatorCommand& message) const {
  const double speed = model.skeleton().velocity()[coordinate_];
  for (const Tendon& tendon : tendons_)
    append(tendon.name, erp::Mode::length,
           tendon.brake_line_m - params_.brake_s * lever_m(tendon, model) * speed, message);
}

void JointDrive::update_references(double torque_Nm, double dt_s) {
  torque_.smooth(torque_Nm, dt_s, params_.smooth_s);
  const ReferenceTension raised{params_.low_N, params_.high_N, params_.width_Nm, params_.lead_s};
  const double max_change_N = params_.raise_N_per_s * dt_s;
  target_N_ +=
      std::clamp(raised.of(torque_.value, torque_.rate) - target_N_, -max_change_N, max_change_N);
  reference_.smooth(target_N_, dt_s, params_.raise_s);
}

void JointDrive::drive(double torque_Nm, double acceleration, const sim::Musculoskeletal& model,
                       double dt_s, erp::ActuatorCommand& message) {
  update_references(torque_Nm, dt_s);
  const std::array levers_m{lever_m(tendons_[0], model), lever_m(tendons_[1], model)};
  const Pair pair{{std::abs(levers_m[0]), std::abs(levers_m[1])}};
  const auto tension_N = pair.tensions_N(torque_.value, reference_.value);
  const double speed = model.skeleton().velocity()[coordinate_];
  bool within_supply = true;
  for (std::size_t k = 0; k < 2; ++k) {
    const bool pulls = pair.positive_pulls(torque_.value) == (k == 0);
    const double tension_per_torque = pulls ? (k == 0 ? 1 : -1) / pair.arm_m[k] : 0;  // dF_d/dτ
    within_supply =
        command(k, tension_N[k], tension_per_torque, speed, levers_m[k], acceleration, message) &&
        within_supply;
  }
  saturation_ += dt_s / (1 + dt_s) * ((within_supply ? 0 : 1) - saturation_);
}

bool JointDrive::command(std::size_t index, double tension_N, double tension_per_torque,
                         double speed, double lever_m, double acceleration,
                         erp::ActuatorCommand& message) const {
  const Tendon& t = tendons_[index];
  const TensionLinearisation::Desired desired{
      std::min(tension_N, t.max_N), reference_.rate + tension_per_torque * torque_.rate,
      reference_.acceleration + tension_per_torque * torque_.acceleration};
  const double voltage_V = t.law.voltage_V(
      {t.tension_N, t.speed_rad_per_s, lever_m * speed, lever_m * acceleration}, desired);
  append(t.name, erp::Mode::voltage, std::clamp(voltage_V, -t.supply_V, t.supply_V), message);
  return std::abs(voltage_V) <= t.supply_V;
}

/// Two first-order lags in series: value, and its first and second derivative.
void JointDrive::Smooth::smooth(double target, double dt_s, double smooth_s) {
  // ẍ = (target − x) / T² − 2 ẋ / T, implicit Euler
  const double T = smooth_s, h = dt_s;
  acceleration = ((target - value) / (T * T) - 2 * rate / T - h * rate / (T * T)) /
                 (1 + 2 * h / T + h * h / (T * T));
  rate += h * acceleration;
  value += h * rate;
}

}  // namespace control

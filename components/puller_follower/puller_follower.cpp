#include "components/puller_follower/puller_follower.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <utility>

namespace control {
namespace {

constexpr double rest_rad_per_s = 0.15;  // chosen: a joint below this speed is at rest
constexpr double rest_s = 0.1;           // chosen: longer than the reversal of an oscillation
// Chosen: below this speed the compensation of Coulomb friction is proportional to the speed.
constexpr double viscous_below_rad_per_s = 0.02;

/// τ_f at the desired speed, so that it does not chatter.
double friction_Nm(const sim::loop_shaping::Hinge& hinge, double desired_rad_per_s) {
  const double divisor_rad_per_s = std::max(std::abs(desired_rad_per_s), viscous_below_rad_per_s);
  return (hinge.viscous_Nm_s_per_rad + hinge.coulomb_Nm / divisor_rad_per_s) * desired_rad_per_s;
}

/// The parameters with the loop shape read from its file.
PullerFollower::Params with_loop_shape(PullerFollower::Params params) {
  if (params.drives.high_N < params.drives.low_N)
    throw std::invalid_argument(
        "high_N, the reference tension at a change of roles, must not be below low_N; "
        "give " +
        std::to_string(params.drives.low_N) + " or more");
  if (params.law != Law::loop_shaping || params.loops.empty()) return params;
  const auto folder = std::filesystem::path(params.place.file).parent_path();
  params.laws.shape = xml::read<sim::loop_shaping::JointShape>((folder / params.loops).string());
  params.drives.smooth_s = params.laws.shape.smooth_s;
  return params;
}

}  // namespace

PullerFollower::PullerFollower(const Params& params, const erp::Robot& robot)
    : params_(with_loop_shape(params)),
      names_(robot),
      model_(robot),
      hinges_(sim::loop_shaping::hinges_of(model_)),
      measured_(names_.size()),
      desired_(names_.size()),
      holding_pose_(names_.size()),
      errors_(model_.coordinates()),
      dynamics_(model_.coordinates()),
      factor_(model_.coordinates()),
      acting_Nm_(Eigen::VectorXd::Zero(model_.coordinates())),
      torque_Nm_(acting_Nm_),
      friction_Nm_(acting_Nm_),
      acceleration_(acting_Nm_),
      disturbance_(model_.coordinates()) {
  for (const auto& hinge : hinges_) drives_.emplace_back(robot, model_, hinge, params_.drives);
  law_ = law_of(params_.law, params_.laws, model_);
}

std::optional<erp::ActuatorCommand> PullerFollower::step(
    const erp::SensorFrame& frame, double dt_s, const node::Latest<erp::JointState>& state,
    const node::Latest<erp::JointTarget>& target) {
  const bool sensed = read_sensors(frame, dt_s);
  const bool inputs_valid = sensed && state && state.age_s <= params_.stale_s &&
                            names_.read(state.message, frame.stamp_ns, measured_) && target &&
                            target.age_s <= params_.stale_s &&
                            names_.read(target.message, frame.stamp_ns, desired_);
  const Phase before = std::exchange(phase_, inputs_valid ? next_phase() : Phase::idle);
  if (!inputs_valid) return std::nullopt;
  const bool continues = phase_ == before && dt_s <= params_.stale_s;
  model_.place(measured_);
  return phase_ == Phase::braking ? brake(continues, dt_s) : track(continues, dt_s);
}

PullerFollower::Phase PullerFollower::next_phase() const {
  const bool still_braking = phase_ == Phase::braking && rest_s_ < rest_s;
  if (still_braking || std::ranges::any_of(drives_, &JointDrive::is_saturated))
    return Phase::braking;
  return std::ranges::any_of(drives_, &JointDrive::is_slack) ? Phase::holding : Phase::tracking;
}

erp::ActuatorCommand PullerFollower::brake(bool continues, double dt_s) {
  if (!continues) {
    report_saturation();
    std::ranges::for_each(drives_, &JointDrive::stop);
    rest_s_ = 0;
  }
  const bool is_at_rest = model_.skeleton().velocity().cwiseAbs().maxCoeff() < rest_rad_per_s;
  rest_s_ = is_at_rest ? rest_s_ + dt_s : 0;
  erp::ActuatorCommand command;
  for (const JointDrive& drive : drives_) drive.brake(model_, command);
  return command;
}

void PullerFollower::report_saturation() const {
  if (!node_) return;
  for (std::size_t k = 0; k < drives_.size(); ++k)
    if (drives_[k].is_saturated())
      node_->report(erp::Severity::warning, hinges_[k].name, "saturated",
                    "its motors saturate; the joints are braked until all are at "
                    "rest, then control "
                    "resumes");
}

erp::ActuatorCommand PullerFollower::track(bool continues, double dt_s) {
  const double elapsed_s = continues ? dt_s : 0;
  dynamics_.update(model_.skeleton());
  for (std::size_t k = 0; k < drives_.size(); ++k)
    acting_Nm_[hinges_[k].coordinate] = drives_[k].torque_Nm(model_);
  if (!continues) begin();
  tracking_s_ += elapsed_s;
  if (phase_ == Phase::holding) std::ranges::copy(holding_pose_, desired_.begin());
  else catch_up_.add(tracking_s_, desired_);
  update_errors();
  compute_torques(elapsed_s);
  compute_acceleration(elapsed_s);
  erp::ActuatorCommand command;
  for (std::size_t k = 0; k < drives_.size(); ++k) {
    const int coordinate = hinges_[k].coordinate;
    if (!continues) drives_[k].begin(torque_Nm_[coordinate]);
    drives_[k].drive(torque_Nm_[coordinate], acceleration_[coordinate], model_, elapsed_s, command);
  }
  return command;
}

bool PullerFollower::read_sensors(const erp::SensorFrame& frame, double dt_s) {
  bool all_measured = true;
  for (JointDrive& drive : drives_) all_measured = drive.read_sensors(frame, dt_s) && all_measured;
  return all_measured;
}

void PullerFollower::begin() {
  law_->begin(acting_Nm_, dynamics_);
  tracking_s_ = 0;
  catch_up_ = joints::catch_up(measured_, desired_, params_.start_rad_per_s);
  for (std::size_t j = 0; j < measured_.size(); ++j) {
    holding_pose_[j].now = measured_[j];
    holding_pose_[j].now.velocity_rad_per_s = {};
  }
}

void PullerFollower::update_errors() {
  for (const auto& hinge : hinges_) {
    const auto joint = static_cast<std::size_t>(hinge.joint);
    const int coordinate = hinge.coordinate;
    const sim::JointMotion& desired = desired_[joint];
    const sim::JointReading& now = measured_[joint];
    errors_.error_rad[coordinate] = desired.now.position[0] - now.position[0];
    errors_.desired_rad_per_s[coordinate] = desired.now.velocity_rad_per_s[0];
    errors_.error_rad_per_s[coordinate] =
        errors_.desired_rad_per_s[coordinate] - now.velocity_rad_per_s[0];
    errors_.desired_rad_per_s2[coordinate] = desired.acceleration_rad_per_s2[0];
  }
}

void PullerFollower::compute_torques(double dt_s) {
  torque_Nm_ = law_->torque_Nm(errors_, dynamics_, dt_s);
  for (const auto& hinge : hinges_) {
    const int coordinate = hinge.coordinate;
    friction_Nm_[coordinate] = friction_Nm(hinge, errors_.desired_rad_per_s[coordinate]);
  }
  torque_Nm_ += params_.friction * friction_Nm_;
}

/// Acceleration under the commanded torque. The disturbance is estimated from the acting torque.
/// `dt_s` 0: control begins.
void PullerFollower::compute_acceleration(double dt_s) {
  factor_.compute(dynamics_.inertia);
  const auto model_acceleration = [&](const Eigen::VectorXd& torque_Nm) -> const Eigen::VectorXd& {
    acceleration_ = torque_Nm - dynamics_.bias - friction_Nm_;
    factor_.solveInPlace(acceleration_);
    return acceleration_;
  };
  const Eigen::VectorXd& speed = model_.skeleton().velocity();
  if (dt_s > 0) disturbance_.update(speed, model_acceleration(acting_Nm_), dt_s);
  else disturbance_.begin(speed, model_acceleration(acting_Nm_));
  model_acceleration(torque_Nm_);
  acceleration_ += disturbance_.acceleration_rad_per_s2();
}

}  // namespace control

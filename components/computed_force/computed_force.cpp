#include "components/computed_force/computed_force.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "components/node/controller_helpers.hpp"

namespace control {
namespace {

using Eigen::Quaterniond;
using sim::vec, sim::Vec3;

/// Chosen: below this speed the compensation of Coulomb friction is proportional to the speed.
constexpr double viscous_below_rad_per_s = 0.02;
constexpr double unknown_N = -1;  // marks a tension without a value

Quaterniond rotation_of(const sim::JointReading& reading) {
  const auto& q = reading.position;
  return Quaterniond(q[0], q[1], q[2], q[3]).normalized();
}

/// Rotation from the target's frame into the joint's own frame.
Eigen::Matrix3d into_joint_frame(const sim::JointReading& now, const sim::JointReading& desired) {
  if (now.type != erp::JointType::spherical) return Eigen::Matrix3d::Identity();
  return (rotation_of(now).conjugate() * rotation_of(desired)).toRotationMatrix();
}

/// Path of the muscles file, which is relative to the config.
std::string muscles_file(const ComputedForce::Params& params) {
  if (params.muscles.empty()) return "";
  return (std::filesystem::path(params.place.file).parent_path() / params.muscles).string();
}

}  // namespace

ComputedForce::ComputedForce(const Params& params, const erp::Robot& robot)
    : params_(params),
      robot_(robot),
      names_(robot),
      model_(robot),
      jacobian_source_(jacobian_source(params.jacobian, muscles_file(params), robot, model_)),
      distribution_(sim::objective_terms(robot, params.objective, params.least_N),
                    model_.coordinates()),
      measured_(names_.size()),
      desired_(names_.size()),
      acceleration_(Vector::Zero(model_.coordinates())),
      integral_(acceleration_),
      bias_(acceleration_),
      torque_(acceleration_),
      last_N_(Vector::Zero(static_cast<Eigen::Index>(robot.actuators.size()))),
      rate_N_per_s_(last_N_),
      line_rate_(last_N_),
      line_acceleration_(last_N_),
      inertia_(model_.coordinates(), model_.coordinates()) {
  speed_d_ = acceleration_d_ = acceleration_;
  for (const erp::Actuator& actuator : robot.actuators)
    force_references_.emplace_back(robot, actuator);
}

std::optional<erp::ActuatorCommand> ComputedForce::step(
    const erp::SensorFrame& frame, double dt_s, const node::Latest<erp::JointState>& state,
    const node::Latest<erp::JointTarget>& target) {
  const bool inputs_valid = state && state.age_s <= params_.stale_s &&
                            names_.read(state.message, frame.stamp_ns, measured_) && target &&
                            target.age_s <= params_.stale_s &&
                            names_.read(target.message, frame.stamp_ns, desired_);
  if (!std::exchange(inputs_were_valid_, inputs_valid))
    integral_.setZero(), rate_N_per_s_.setZero(), last_N_.setConstant(unknown_N);
  if (!inputs_valid) return std::nullopt;
  model_.place(measured_);
  reference_acceleration(dt_s);
  model_.skeleton().inertia(inertia_);
  model_.skeleton().bias(bias_);
  torque_ = bias_;
  torque_.noalias() += inertia_ * acceleration_;
  add_friction();
  fix_tripped_tensions(frame);
  jacobian_source_->update(measured_, frame);
  const Eigen::MatrixXd& jacobian = jacobian_source_->at(measured_);
  return command(jacobian, distribution_.distribute(jacobian, torque_), dt_s);
}

/// a_ref, joint by joint.
void ComputedForce::reference_acceleration(double dt_s) {
  acceleration_.setZero();
  for (std::size_t j = 0; j < measured_.size(); ++j) {
    const int first = model_.skeleton().first_of(static_cast<int>(j));
    const int dof = std::min(sim::coordinates_of(measured_[j].type), 3);
    if (first < 0 || names_.list()[j].type == erp::JointType::free) continue;
    const Eigen::Matrix3d to_joint_frame = into_joint_frame(measured_[j], desired_[j].now);
    const Vec3 e =
        vec(sim::displacement(measured_[j].type, measured_[j].position, desired_[j].now.position));
    const Vec3 desired_speed = to_joint_frame * vec(desired_[j].now.velocity_rad_per_s);
    const Vec3 speed_error = desired_speed - vec(measured_[j].velocity_rad_per_s);
    const Vec3 desired_acceleration = to_joint_frame * vec(desired_[j].acceleration_rad_per_s2);
    for (int d = 0; d < dof; ++d) {
      speed_d_[first + d] = desired_speed[d], acceleration_d_[first + d] = desired_acceleration[d];
      double& sum = integral_[first + d];
      sum = std::clamp(sum + dt_s * e[d], -params_.integral_rad_s, params_.integral_rad_s);
      acceleration_[first + d] = desired_acceleration[d] + params_.kd_per_s * speed_error[d] +
                                 params_.kp_per_s2 * e[d] + params_.ki_per_s3 * sum;
    }
  }
}

/// τ_f = µ v_d + τ_C v_d/|v_d|, at the desired velocity, so that it does not chatter.
void ComputedForce::add_friction() {
  for (std::size_t j = 0; j < measured_.size(); ++j) {
    const int first = model_.skeleton().first_of(static_cast<int>(j));
    const erp::Joint& joint = names_.list()[j];
    if (first < 0 || params_.friction == 0) continue;
    const Vec3 v = vec(desired_[j].now.velocity_rad_per_s);
    const double friction_per_speed =
        joint.viscous_Nm_s_per_rad + joint.coulomb_Nm / std::max(v.norm(), viscous_below_rad_per_s);
    for (int d = 0; d < std::min(sim::coordinates_of(joint.type), 3); ++d)
      torque_[first + d] += params_.friction * friction_per_speed * v[d];
  }
}

/// Fixes the tension of tendons whose ECU has tripped at the measured value.
void ComputedForce::fix_tripped_tensions(const erp::SensorFrame& frame) {
  for (const erp::ActuatorSample& sample : erp::samples(frame.actuators))
    for (std::size_t a = 0; a < robot_.actuators.size(); ++a) {
      if (robot_.actuators[a].name != sample.name) continue;
      const bool tripped = static_cast<erp::EcuState>(sample.ecu_state) == erp::EcuState::fault;
      const double measured_N =
          sample.valid & erp::valid::tension ? std::max(0.0, sample.tension_N) : 0;
      distribution_.fix(static_cast<int>(a), tripped ? measured_N : unknown_N);
    }
}

erp::ActuatorCommand ComputedForce::command(const Eigen::MatrixXd& jacobian,
                                            const Vector& tension_N, double dt_s) {
  erp::ActuatorCommand command;
  line_rate_.noalias() = jacobian * speed_d_;
  line_acceleration_.noalias() = jacobian * acceleration_d_;
  for (std::size_t a = 0; a < robot_.actuators.size(); ++a) {
    const auto i = static_cast<Eigen::Index>(a);
    const double rate = last_N_[i] >= 0 && dt_s > 0 ? (tension_N[i] - last_N_[i]) / dt_s : 0;
    rate_N_per_s_[i] += dt_s / (dt_s + params_.rate_s) * (rate - rate_N_per_s_[i]);
    const double reference_N = force_references_[a].reference_N(
        {tension_N[i], rate_N_per_s_[i], line_rate_[i], line_acceleration_[i]});
    node::append_reference(
        command, robot_.actuators[a].name, erp::Mode::force,
        std::clamp(tension_N[i] + params_.lag_compensation * (reference_N - tension_N[i]), 0.0,
                   robot_.actuators[a].max_tension_N));
  }
  last_N_ = tension_N;
  return command;
}

}  // namespace control

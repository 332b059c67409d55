#include "components/pose_estimator/pose_filter.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace pose {

PoseFilter::PoseFilter(const erp::Robot& robot, const FilterOptions& options)
    : options_(options), model_(robot), gravity_m_per_s2_(sim::vec(robot.gravity_m_per_s2())) {
  const Eigen::Index n = model_.coordinates();
  for (const erp::Joint& joint : model_.tree().joints)
    joints_.push_back(sim::initial_reading(joint));
  viscous_.resize(static_cast<std::size_t>(n));
  for (std::size_t j = 0; j < joints_.size(); ++j)
    for (int d = 0; d < sim::coordinates_of(joints_[j].type); ++d)
      if (const int first = model_.skeleton().first_of(static_cast<int>(j)); first >= 0)
        viscous_[static_cast<std::size_t>(first + d)] =
            model_.tree().joints[j].viscous_Nm_s_per_rad;
  parents_.assign(viscous_.size(), -1);
  for (const sim::TreeBody& body : model_.tree().bodies)
    for (int d = 0;
         body.joint >= 0 && d < sim::coordinates_of(joints_[std::size_t(body.joint)].type); ++d)
      if (const int first = model_.skeleton().first_of(body.joint); first >= 0)
        parents_[static_cast<std::size_t>(first + d)] = body.parent;
  for (Vector* v : {&speed_, &step_, &bias_, &torque_}) v->setZero(n);
  for (Vector* v : {&error_, &gain_, &row_}) v->setZero(2 * n);
  inertia_.setZero(n, n);
  p_.setZero(2 * n, 2 * n);
  p_.diagonal().head(n).setConstant(options.start_rad * options.start_rad);
  p_.diagonal().tail(n).setConstant(options.start_rad_per_s * options.start_rad_per_s);
}

// ---- prediction ----

void PoseFilter::predict(double dt_s, const Vector& tension_N) {
  const Eigen::Index n = speed_.size();
  accelerate(dt_s, tension_N);
  step_ = dt_s * speed_;
  move_joints(step_);
  model_.place(joints_);
  auto qq = p_.topLeftCorner(n, n);
  auto qv = p_.topRightCorner(n, n);
  auto vv = p_.bottomRightCorner(n, n);
  qq += dt_s * (qv + qv.transpose()) + dt_s * dt_s * vv;
  qv += dt_s * vv;
  const double speed_variance =
      options_.acceleration_rad_per_s2 * options_.acceleration_rad_per_s2 * dt_s * dt_s;
  qq.diagonal().array() += speed_variance * dt_s * dt_s / 4;
  qv.diagonal().array() += speed_variance * dt_s / 2;
  vv.diagonal().array() += speed_variance;
  p_.bottomLeftCorner(n, n) = qv.transpose();
}

/// v ← v + H⁻¹ (−Lᵀ F − µ v − C − τ_G) dt
void PoseFilter::accelerate(double dt_s, const Vector& tension_N) {
  auto& skeleton = model_.skeleton();
  skeleton.inertia(inertia_);
  skeleton.bias(bias_);
  torque_ = -bias_;
  torque_.noalias() -= model_.jacobian().transpose() * tension_N;
  for (Eigen::Index d = 0; d < speed_.size(); ++d) {
    torque_[d] -= viscous_[static_cast<std::size_t>(d)] * speed_[d];
    inertia_(d, d) += viscous_[static_cast<std::size_t>(d)] * dt_s;
  }
  Eigen::LLT<Eigen::Ref<Matrix>> factor(inertia_);
  factor.solveInPlace(torque_);
  speed_ += dt_s * torque_;
}

/// q ← q ⊕ displacement; also copies the velocities.
void PoseFilter::move_joints(const Eigen::Ref<const Vector>& displacement) {
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    const int first = model_.skeleton().first_of(static_cast<int>(j));
    if (first < 0) continue;
    std::array<double, 3> rotation_rad{};
    for (int d = 0; d < std::min(sim::coordinates_of(joints_[j].type), 3); ++d) {
      rotation_rad[static_cast<std::size_t>(d)] = displacement[first + d];
      joints_[j].velocity_rad_per_s[static_cast<std::size_t>(d)] = speed_[first + d];
    }
    joints_[j].position = sim::displaced(joints_[j].type, joints_[j].position, rotation_rad);
  }
}

// ---- updates ----

bool PoseFilter::update_length(int actuator, double length_m, double sigma_m) {
  row_.setZero();
  row_.head(speed_.size()) = model_.jacobian().row(actuator);
  return update(row_, length_m - model_.length_m()[actuator], sigma_m);
}

bool PoseFilter::update_joint(int joint, const std::array<double, 4>& position, double sigma_rad) {
  const auto j = static_cast<std::size_t>(joint);
  const int first = model_.skeleton().first_of(joint);
  if (first < 0) return false;
  const auto rotation_rad = sim::displacement(joints_[j].type, joints_[j].position, position);
  bool all_accepted = true;
  for (int d = 0; d < std::min(sim::coordinates_of(joints_[j].type), 3); ++d) {
    row_.setZero();
    row_[first + d] = 1;
    all_accepted =
        update(row_, rotation_rad[static_cast<std::size_t>(d)], sigma_rad) && all_accepted;
  }
  return all_accepted;
}

/// Rotation axis of S_d in a body's own axes.
sim::Vec3 PoseFilter::axis_on(int body, int coordinate) const {
  const auto& pose = model_.skeleton().poses()[static_cast<std::size_t>(body)];
  return pose.rotation.transpose() * model_.skeleton().axis(coordinate).head<3>();
}

/// ω of the parent body of a coordinate's joint.
sim::Vec3 PoseFilter::parent_angular_rad_per_s(int coordinate) const {
  const int parent = parents_[static_cast<std::size_t>(coordinate)];
  if (parent < 0) return sim::Vec3::Zero();
  return model_.skeleton().twists()[static_cast<std::size_t>(parent)].angular_rad_per_s;
}

bool PoseFilter::update_angular_velocity(int body, const sim::Vec3& measured_rad_per_s,
                                         double sigma) {
  const auto b = static_cast<std::size_t>(body);
  const auto& skeleton = model_.skeleton();
  const Eigen::Matrix3d to_body = skeleton.poses()[b].rotation.transpose();
  const sim::Vec3 innovation =
      measured_rad_per_s - to_body * skeleton.twists()[b].angular_rad_per_s;
  bool all_accepted = true;
  for (int axis = 0; axis < 3; ++axis) {
    row_.setZero();
    for (const int d : skeleton.movers(body)) {
      const sim::Vec3 axis_in_world = skeleton.axis(d).head<3>();
      row_[speed_.size() + d] = (to_body * axis_in_world)[axis];
      row_[d] = (to_body * parent_angular_rad_per_s(d).cross(axis_in_world))[axis];
    }
    all_accepted = update(row_, innovation[axis], sigma) && all_accepted;
  }
  return all_accepted;
}

bool PoseFilter::update_gravity(int body, const sim::Vec3& force_m_per_s2, double sigma) {
  const auto& pose = model_.skeleton().poses()[static_cast<std::size_t>(body)];
  const sim::Vec3 up = -(pose.rotation.transpose() * gravity_m_per_s2_);
  bool all_accepted = true;
  for (int axis = 0; axis < 3; ++axis) {
    row_.setZero();
    for (const int d : model_.skeleton().movers(body)) row_[d] = up.cross(axis_on(body, d))[axis];
    all_accepted = update(row_, force_m_per_s2[axis] - up[axis], sigma) && all_accepted;
  }
  return all_accepted;
}

/// `innovation`: measured minus predicted, at the pose relative to which δ is defined.
bool PoseFilter::update(const Vector& h, double innovation, double sigma) {
  const double residual = innovation - h.dot(error_);
  gain_.noalias() = p_ * h;
  const double variance = h.dot(gain_) + sigma * sigma;
  if (!(residual * residual <= options_.gate * options_.gate * variance)) return false;
  error_ += (residual / variance) * gain_;
  p_.noalias() -= (1 / variance) * gain_ * gain_.transpose();
  return true;
}

void PoseFilter::apply_correction() {
  const Eigen::Index n = speed_.size();
  speed_ += error_.tail(n);
  move_joints(error_.head(n));
  error_.setZero();
  model_.place(joints_);
}

}  // namespace pose

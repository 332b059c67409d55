#include "sim/world/step_solver.hpp"

#include <algorithm>
#include <cmath>

namespace sim {
namespace {

constexpr double gradient_tolerance = 1e-12;  // of the largest impulse: rounding error
constexpr double min_fraction = 1e-12;        // chosen: smallest fraction of a step
constexpr double max_relative_turn = 1e-4;    // chosen: Newton's error is then its square
constexpr double slope_tolerance = 1e-9;      // chosen: of the slope at the start of a step
// States of a force or a joint at a velocity.
constexpr char idle = '-', acting = 'f', sticking = '0', up = '>', down = '<', rotating = 'o',
               unknown = '?';

}  // namespace

StepSolver::StepSolver(int coordinates, int forces, std::vector<JointFriction> frictions)
    : frictions_(std::move(frictions)),
      force_N_(static_cast<std::size_t>(forces)),
      joints_(frictions_.size()),
      start_sliding_(frictions_.size()),
      stiffness_(coordinates, coordinates),
      system_(coordinates, coordinates),
      gradient_(coordinates),
      step_(coordinates),
      start_velocity_(coordinates),
      factor_(coordinates) {
  pattern_.reserve(static_cast<std::size_t>(forces) + frictions_.size());
  factored_pattern_.reserve(pattern_.capacity() + 1);
}

void StepSolver::begin(const Eigen::MatrixXd& h, std::span<const OneSidedForce> forces,
                       double dt_s) {
  h_ = &h, forces_ = forces, dt_s_ = dt_s;
  pattern_.assign(forces.size() + frictions_.size(), idle);
  factored_pattern_.assign(pattern_.size() + 1, unknown);
}

/// The gradient at v, and the pattern there. For a joint at rest it is the smallest subgradient:
/// zero if friction holds the joint, otherwise the direction in which it starts.
void StepSolver::differentiate(const Eigen::VectorXd& p, const Eigen::VectorXd& v) {
  gradient_ = -p;
  gradient_.noalias() += *h_ * v;
  double largest_impulse = p.lpNorm<Eigen::Infinity>();
  has_rotating_joint_ = false;
  for (std::size_t k = 0; k < forces_.size(); ++k) {
    const OneSidedForce& force = forces_[k];
    force_N_[k] = std::max(0.0, force.start_N + force.gain_N_s_per_m * force.along(v));
    pattern_[k] = force_N_[k] > 0 ? acting : idle;
    if (force_N_[k] == 0) continue;
    for (const auto& term : force.row) {
      const double impulse = dt_s_ * force_N_[k] * term.slope;
      gradient_[term.coordinate] += impulse;
      largest_impulse = std::max(largest_impulse, std::abs(impulse));
    }
  }
  largest_impulse_ = largest_impulse;
  for (std::size_t j = 0; j < frictions_.size(); ++j) evaluate_friction(j, v);
}

void StepSolver::evaluate_friction(std::size_t j, const Eigen::VectorXd& v) {
  const JointFriction& joint = frictions_[j];
  const auto joint_velocity = v.segment(joint.first, joint.dofs);
  auto slope = gradient_.segment(joint.first, joint.dofs);
  slope += dt_s_ * joint.viscous_Nm_s_per_rad * joint_velocity;
  const double bound = dt_s_ * joint.coulomb_Nm;
  char& pattern = pattern_[forces_.size() + j];
  pattern = idle;
  if (bound <= 0) return;
  auto& [direction, speed] = joints_[j];
  direction.setZero();
  speed = joint_velocity.norm();
  if (speed > 0) {
    direction.head(joint.dofs) = joint_velocity / speed;
  } else if (const double load = slope.norm(); load > bound) {
    direction.head(joint.dofs) = -slope / load;
    speed = (load - bound) / h_->block(joint.first, joint.first, joint.dofs, joint.dofs).trace();
  } else {
    pattern = sticking;
    slope.setZero();
    return;
  }
  slope += bound * direction.head(joint.dofs);
  pattern = joint.dofs == 3 ? rotating : direction[0] > 0 ? up : down;
  has_rotating_joint_ = has_rotating_joint_ || pattern == rotating;
}

void StepSolver::add_friction(std::size_t j) {
  const JointFriction& joint = frictions_[j];
  const char pattern = pattern_[forces_.size() + j];
  for (int d = joint.first; d < joint.first + joint.dofs; ++d) {
    system_(d, d) += dt_s_ * joint.viscous_Nm_s_per_rad;
    if (pattern != sticking) continue;
    system_.row(d).setZero(), system_.col(d).setZero();
    system_(d, d) = 1;
  }
  if (pattern == rotating)
    system_.block<3, 3>(joint.first, joint.first) +=
        dt_s_ * joint.coulomb_Nm / joints_[j].speed *
        (Eigen::Matrix3d::Identity() - joints_[j].direction * joints_[j].direction.transpose());
}

/// H plus the contribution of the active forces.
void StepSolver::assemble_stiffness() {
  stiffness_ = *h_;
  for (std::size_t k = 0; k < forces_.size(); ++k) {
    if (pattern_[k] != acting) continue;
    const double gain = dt_s_ * forces_[k].gain_N_s_per_m;
    for (const auto& a : forces_[k].row)
      for (const auto& b : forces_[k].row)
        stiffness_(a.coordinate, b.coordinate) += gain * a.slope * b.slope;
  }
}

void StepSolver::factor() {
  const auto forces = static_cast<std::ptrdiff_t>(forces_.size());
  const bool is_unchanged =
      factored_pattern_.size() == pattern_.size() &&
      std::equal(pattern_.begin(), pattern_.begin() + forces, factored_pattern_.begin());
  if (!is_unchanged) assemble_stiffness();
  system_ = stiffness_;
  for (std::size_t j = 0; j < frictions_.size(); ++j) add_friction(j);
  factor_.compute(system_);
  factored_pattern_ = pattern_;
}

/// Newton's step from v. A joint that other joints would push against its starting direction stays
/// at rest.
void StepSolver::compute_step(const Eigen::VectorXd& v) {
  for (bool consistent = false; !consistent;) {
    if (has_rotating_joint_ || pattern_ != factored_pattern_) factor();
    factor_.solve(gradient_, step_);
    step_ = -step_;
    consistent = true;
    for (std::size_t j = 0; j < frictions_.size(); ++j) {
      const auto [first, dofs, viscous, coulomb] = frictions_[j];
      char& pattern = pattern_[forces_.size() + j];
      if (pattern == idle || pattern == sticking || !v.segment(first, dofs).isZero(0)) continue;
      if (joints_[j].direction.head(dofs).dot(step_.segment(first, dofs)) >= 0) continue;
      pattern = sticking;
      gradient_.segment(first, dofs).setZero();
      consistent = false;
    }
  }
}

/// Takes a fraction of the step. A joint whose velocity would reverse stops instead. Returns true
/// for a full step in which no velocity reverses and the axis of no ball joint's velocity turns
/// much.
bool StepSolver::advance(double fraction, Eigen::VectorXd& v) const {
  v = start_velocity_ + fraction * step_;
  bool is_full_step = fraction == 1;
  for (std::size_t j = 0; j < frictions_.size(); ++j) {
    const auto [first, dofs, viscous, coulomb] = frictions_[j];
    const char pattern = factored_pattern_[forces_.size() + j];
    if (pattern == idle || pattern == sticking) continue;
    auto joint_velocity = v.segment(first, dofs);
    const bool reverses = start_sliding_[j].direction.head(dofs).dot(joint_velocity) <= 0;
    if (reverses) joint_velocity.setZero();
    is_full_step = is_full_step && !reverses;
    if (pattern == rotating)
      is_full_step = is_full_step && step_.segment(first, dofs).norm() <=
                                         max_relative_turn * start_sliding_[j].speed;
  }
  return is_full_step;
}

/// Takes the step, halved until the function decreases. Returns true for a full Newton step.
/// Because the function is convex, it is lower than at the start if it still decreases at the end
/// of the step.
bool StepSolver::descend(const Eigen::VectorXd& p, Eigen::VectorXd& v) {
  start_velocity_ = v;
  start_sliding_ = joints_;
  const double max_slope = slope_tolerance * std::abs(gradient_.dot(step_));
  bool is_full_step = false;
  for (double fraction = 1; fraction > min_fraction; fraction /= 2) {
    is_full_step = advance(fraction, v);
    differentiate(p, v);
    if (gradient_.dot(v - start_velocity_) <= max_slope) break;
  }
  return is_full_step;
}

void StepSolver::approach(const Eigen::VectorXd& p, Eigen::VectorXd& v) {
  if (v.size() == 0) return;
  differentiate(p, v);
  compute_step(v);
  start_velocity_ = v;
  start_sliding_ = joints_;
  advance(1, v);
}

bool StepSolver::solve(const Eigen::VectorXd& p, Eigen::VectorXd& v, int max_steps) {
  differentiate(p, v);
  if (v.size() == 0) return true;
  for (int k = 0; k < max_steps; ++k) {
    compute_step(v);
    const bool is_full_step = descend(p, v);
    const bool is_minimum =
        gradient_.lpNorm<Eigen::Infinity>() <= gradient_tolerance * largest_impulse_;
    if (is_minimum || (is_full_step && pattern_ == factored_pattern_)) return true;
  }
  return false;
}

}  // namespace sim

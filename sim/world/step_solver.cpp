#include "sim/world/step_solver.hpp"

#include <algorithm>
#include <cmath>

namespace sim {
namespace {

constexpr double balanced = 1e-12;        // of the largest impulse: rounding error
constexpr double least_fraction = 1e-12;  // smallest fraction of a step
constexpr double small_turn = 1e-4;       // the error of Newton's method is then its square
constexpr double level_slope = 1e-9;  // of the slope at the start of a step: its end is the minimum
// States of a force or a joint at a velocity.
constexpr char idle = '-', acting = 'f', still = '0', up = '>', down = '<', rotating = 'o',
               unknown = '?';

}  // namespace

StepSolver::StepSolver(int coordinates, int forces, std::vector<JointFriction> frictions)
    : frictions_(std::move(frictions)),
      force_N_(static_cast<std::size_t>(forces)),
      joints_(frictions_.size()),
      start_(frictions_.size()),
      stiff_(coordinates, coordinates),
      system_(coordinates, coordinates),
      gradient_(coordinates),
      step_(coordinates),
      before_(coordinates),
      factor_(coordinates) {
  pattern_.reserve(static_cast<std::size_t>(forces) + frictions_.size());
  factored_.reserve(pattern_.capacity() + 1);
}

void StepSolver::begin(const Eigen::MatrixXd& h, std::span<const OneSidedForce> forces,
                       double dt_s) {
  h_ = &h, forces_ = forces, dt_s_ = dt_s;
  pattern_.assign(forces.size() + frictions_.size(), idle);
  factored_.assign(pattern_.size() + 1, unknown);
}

/// The gradient at v, and the pattern there. For a joint at rest it is the smallest subgradient: zero if
/// friction holds the joint, otherwise the direction in which it starts.
void StepSolver::differentiate(const Eigen::VectorXd& p, const Eigen::VectorXd& v) {
  gradient_ = -p;
  gradient_.noalias() += *h_ * v;
  double largest = p.lpNorm<Eigen::Infinity>();
  curved_ = false;
  for (std::size_t k = 0; k < forces_.size(); ++k) {
    const OneSidedForce& force = forces_[k];
    force_N_[k] = std::max(0.0, force.start_N + force.gain_N_s_per_m * force.along(v));
    pattern_[k] = force_N_[k] > 0 ? acting : idle;
    if (force_N_[k] == 0) continue;
    for (const auto& term : force.row) {
      const double impulse = dt_s_ * force_N_[k] * term.slope;
      gradient_[term.coordinate] += impulse;
      largest = std::max(largest, std::abs(impulse));
    }
  }
  largest_ = largest;
  for (std::size_t j = 0; j < frictions_.size(); ++j) evaluate_friction(j, v);
}

void StepSolver::evaluate_friction(std::size_t j, const Eigen::VectorXd& v) {
  const JointFriction& joint = frictions_[j];
  const auto own = v.segment(joint.first, joint.dofs);
  auto slope = gradient_.segment(joint.first, joint.dofs);
  slope += dt_s_ * joint.viscous_Nm_s_per_rad * own;
  const double bound = dt_s_ * joint.coulomb_Nm;
  char& pattern = pattern_[forces_.size() + j];
  pattern = idle;
  if (bound <= 0) return;
  auto& [direction, speed] = joints_[j];
  direction.setZero();
  speed = own.norm();
  if (speed > 0) {
    direction.head(joint.dofs) = own / speed;
  } else if (const double load = slope.norm(); load > bound) {
    direction.head(joint.dofs) = -slope / load;
    speed = (load - bound) / h_->block(joint.first, joint.first, joint.dofs, joint.dofs).trace();
  } else {
    pattern = still;
    slope.setZero();
    return;
  }
  slope += bound * direction.head(joint.dofs);
  pattern = joint.dofs == 3 ? rotating : direction[0] > 0 ? up : down;
  curved_ = curved_ || pattern == rotating;
}

void StepSolver::add_friction(std::size_t j) {
  const JointFriction& joint = frictions_[j];
  const char pattern = pattern_[forces_.size() + j];
  for (int d = joint.first; d < joint.first + joint.dofs; ++d) {
    system_(d, d) += dt_s_ * joint.viscous_Nm_s_per_rad;
    if (pattern != still) continue;
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
  stiff_ = *h_;
  for (std::size_t k = 0; k < forces_.size(); ++k) {
    if (pattern_[k] != acting) continue;
    const double gain = dt_s_ * forces_[k].gain_N_s_per_m;
    for (const auto& a : forces_[k].row)
      for (const auto& b : forces_[k].row)
        stiff_(a.coordinate, b.coordinate) += gain * a.slope * b.slope;
  }
}

void StepSolver::factor() {
  const auto forces = static_cast<std::ptrdiff_t>(forces_.size());
  const bool same = factored_.size() == pattern_.size() &&
                    std::equal(pattern_.begin(), pattern_.begin() + forces, factored_.begin());
  if (!same) assemble_stiffness();
  system_ = stiff_;
  for (std::size_t j = 0; j < frictions_.size(); ++j) add_friction(j);
  factor_.compute(system_);
  factored_ = pattern_;
}

/// Newton's step from v. A joint that others would push against its starting direction stays at rest.
void StepSolver::compute_step(const Eigen::VectorXd& v) {
  for (bool consistent = false; !consistent;) {
    if (curved_ || pattern_ != factored_) factor();
    factor_.solve(gradient_, step_);
    step_ = -step_;
    consistent = true;
    for (std::size_t j = 0; j < frictions_.size(); ++j) {
      const auto [first, dofs, viscous, coulomb] = frictions_[j];
      char& pattern = pattern_[forces_.size() + j];
      if (pattern == idle || pattern == still || !v.segment(first, dofs).isZero(0)) continue;
      if (joints_[j].direction.head(dofs).dot(step_.segment(first, dofs)) >= 0) continue;
      pattern = still;
      gradient_.segment(first, dofs).setZero();
      consistent = false;
    }
  }
}

/// Takes a fraction of the step. Joints whose velocity would reverse stop instead; true for a full step
/// in which none does and no ball joint turns much.
bool StepSolver::advance(double fraction, Eigen::VectorXd& v) const {
  v = before_ + fraction * step_;
  bool whole = fraction == 1;
  for (std::size_t j = 0; j < frictions_.size(); ++j) {
    const auto [first, dofs, viscous, coulomb] = frictions_[j];
    const char pattern = factored_[forces_.size() + j];
    if (pattern == idle || pattern == still) continue;
    auto own = v.segment(first, dofs);
    const bool turns_back = start_[j].direction.head(dofs).dot(own) <= 0;
    if (turns_back) own.setZero();
    whole = whole && !turns_back;
    if (pattern == rotating)
      whole = whole && step_.segment(first, dofs).norm() <= small_turn * start_[j].speed;
  }
  return whole;
}

/// Takes the step, halved until the function decreases; true for a full Newton step.
/// By convexity the function is lower where it still decreases towards the end of the step.
bool StepSolver::descend(const Eigen::VectorXd& p, Eigen::VectorXd& v) {
  before_ = v;
  start_ = joints_;
  const double level = level_slope * std::abs(gradient_.dot(step_));
  bool whole = false;
  for (double fraction = 1; fraction > least_fraction; fraction /= 2) {
    whole = advance(fraction, v);
    differentiate(p, v);
    if (gradient_.dot(v - before_) <= level) break;
  }
  return whole;
}

void StepSolver::approach(const Eigen::VectorXd& p, Eigen::VectorXd& v) {
  if (v.size() == 0) return;
  differentiate(p, v);
  compute_step(v);
  before_ = v;
  start_ = joints_;
  advance(1, v);
}

bool StepSolver::solve(const Eigen::VectorXd& p, Eigen::VectorXd& v, int most_steps) {
  differentiate(p, v);
  if (v.size() == 0) return true;
  for (int k = 0; k < most_steps; ++k) {
    compute_step(v);
    const bool whole = descend(p, v);
    const bool level = gradient_.lpNorm<Eigen::Infinity>() <= balanced * largest_;
    if (level || (whole && pattern_ == factored_)) return true;
  }
  return false;
}

}  // namespace sim

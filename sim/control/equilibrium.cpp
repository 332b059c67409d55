#include "sim/control/equilibrium.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/model/actuator/musculoskeletal.hpp"
#include "sim/model/actuator/tendon.hpp"

namespace sim {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Joints = std::vector<JointReading>;

}  // namespace

struct Equilibrium::Implementation {
  Implementation(const erp::Robot& robot, std::span<const double> longer_m) : model(robot) {
    for (std::size_t a = 0; a < robot.actuators.size(); ++a) {
      const erp::Actuator& actuator = robot.actuators[a];
      laws.push_back(TendonLaw::at_rest(actuator.tendon, actuator.spindle,
                                        model.length_m()[static_cast<Index>(a)]));
      if (!longer_m.empty()) laws.back().rest_m -= longer_m[a];
    }
    for (const erp::Joint& joint : model.tree().joints)
      if (joint.type == erp::JointType::free)
        throw std::invalid_argument("joint \"" + joint.name +
                                    "\" is free: the equilibrium of its body is not determined by "
                                    "shaft angles; remove the free joint");
    torque_Nm = gravity_Nm = VectorXd::Zero(model.coordinates());
    force_N = VectorXd::Zero(static_cast<Index>(laws.size()));
  }

  int first_of(std::size_t joint) const {
    return model.skeleton().first_of(static_cast<int>(joint));
  }
  const erp::Joint& joint(std::size_t j) const { return model.tree().joints[j]; }

  /// Sets the pose; returns V and writes τ_G + Lᵀ f to `torque_Nm`.
  double place(const Joints& at) {
    model.place(at);
    double energy_J = model.skeleton().energy_J();
    for (Index a = 0; a < force_N.size(); ++a) {
      const TendonLaw& law = laws[static_cast<std::size_t>(a)];
      const double stretch_m =
          law.stretch_m(model.length_m()[a], shaft_rad[static_cast<std::size_t>(a)]);
      force_N[a] = law.spring.force_N(stretch_m);
      energy_J += law.spring.energy_J(stretch_m);
    }
    model.skeleton().gravity_torques(gravity_Nm);
    torque_Nm = gravity_Nm;
    torque_Nm.noalias() += model.jacobian().transpose() * force_N;
    return energy_J;
  }

  /// q ⊕ u.
  Joints displaced_by(Joints q, const VectorXd& u) const {
    for (std::size_t j = 0; j < q.size(); ++j) {
      std::array<double, 3> offset{};
      for (int d = 0; d < coordinates_of(q[j].type); ++d)
        offset[static_cast<std::size_t>(d)] = u[first_of(j) + d];
      q[j].position = displaced(q[j].type, q[j].position, offset);
    }
    return q;
  }
  Joints within_range(Joints q) const {
    for (std::size_t j = 0; j < q.size(); ++j)
      if (q[j].type == erp::JointType::revolute)
        q[j].position[0] = std::clamp(q[j].position[0], joint(j).min_rad, joint(j).max_rad);
    return q;
  }

  /// The coordinates that no stop holds under these torques.
  std::vector<Index> movable(const Joints& q, const VectorXd& torque) const {
    std::vector<Index> movable_coordinates;
    for (std::size_t j = 0; j < q.size(); ++j) {
      const double angle = q[j].position[0];
      const auto is_at_stop = [&] {
        const double motion = -torque[first_of(j)];  // along which V decreases
        return (angle >= joint(j).max_rad && motion > 0) ||
               (angle <= joint(j).min_rad && motion < 0);
      };
      if (q[j].type == erp::JointType::revolute && is_at_stop()) continue;
      for (int d = 0; d < coordinates_of(q[j].type); ++d)
        movable_coordinates.push_back(first_of(j) + d);
    }
    return movable_coordinates;
  }

  /// ∂(τ_G + Lᵀ f)/∂q for some of the coordinates; symmetric where the torques are zero.
  MatrixXd slope(const Joints& q, const VectorXd& torque, const std::vector<Index>& coordinates) {
    constexpr double step_rad = 1e-6;  // chosen
    const auto n = static_cast<Index>(coordinates.size());
    MatrixXd stiffness(n, n);
    for (Index c = 0; c < n; ++c) {
      VectorXd u = VectorXd::Zero(torque.size());
      u[coordinates[static_cast<std::size_t>(c)]] = step_rad;
      place(displaced_by(q, u));
      stiffness.col(c) = (torque_Nm - torque)(coordinates) / step_rad;
    }
    return (stiffness + stiffness.transpose()) / 2;
  }

  /// Limits hinges to their ranges.
  Joints at(const Pose& pose) const {
    Joints q;
    for (std::size_t j = 0; j < pose.size(); ++j)
      q.push_back({.type = joint(j).type, .position = pose[j]});
    return within_range(std::move(q));
  }

  /// Takes one step that decreases V. Returns false if no step decreases it.
  bool decrease_energy(Joints& q, const VectorXd& torque, const std::vector<Index>& coordinates,
                       double& energy_J);

  Musculoskeletal model;
  std::vector<TendonLaw> laws;
  std::span<const double> shaft_rad;
  double damping = 0;  ///< of steps, Nm/rad
  VectorXd torque_Nm, gravity_Nm, force_N;
};

bool Equilibrium::Implementation::decrease_energy(Joints& q, const VectorXd& torque,
                                                  const std::vector<Index>& coordinates,
                                                  double& energy_J) {
  // chosen; damping relative to the largest stiffness
  constexpr int max_attempts = 40;
  constexpr double max_turn_rad = 0.5;  // small enough to count turns around pulleys
  constexpr double first_damping = 1e-6, no_damping = 1e-9;
  constexpr double damping_increase = 4, damping_decrease = 10;
  const MatrixXd stiffness = slope(q, torque, coordinates);
  const double scale = stiffness.diagonal().cwiseAbs().maxCoeff();
  const auto n = static_cast<Index>(coordinates.size());
  for (int attempt = 0; attempt < max_attempts; ++attempt) {
    const Eigen::LLT<MatrixXd> solver(stiffness + damping * MatrixXd::Identity(n, n));
    if (solver.info() == Eigen::Success) {
      VectorXd u = VectorXd::Zero(torque.size());
      u(coordinates) = -solver.solve(VectorXd(torque(coordinates)));
      u *= std::min(1.0, max_turn_rad / u.cwiseAbs().maxCoeff());
      const Joints next = within_range(displaced_by(q, u));
      const double next_energy_J = place(next);
      if (next_energy_J <= energy_J) {
        q = next, energy_J = next_energy_J,
        damping = damping > no_damping * scale ? damping / damping_decrease : 0;
        return true;
      }
    }
    damping = std::max(damping_increase * damping, first_damping * scale);
  }
  return false;
}

Equilibrium::Equilibrium(const erp::Robot& robot, std::span<const double> longer_m)
    : implementation_(std::make_unique<Implementation>(robot, longer_m)) {}
Equilibrium::~Equilibrium() = default;
Equilibrium::Equilibrium(Equilibrium&&) noexcept = default;

Rest Equilibrium::find(std::span<const double> shaft_rad, const Pose& from) {
  constexpr int max_steps = 100;                // chosen
  constexpr double torque_tolerance_Nm = 1e-8;  // chosen
  Implementation& in = *implementation_;
  in.shaft_rad = shaft_rad, in.damping = 0;
  Joints q = in.at(from);
  double energy_J = in.place(q);
  for (int k = 0; k < max_steps; ++k) {
    const VectorXd torque = in.torque_Nm;
    const auto coordinates = in.movable(q, torque);
    if (torque(coordinates).norm() < torque_tolerance_Nm ||
        !in.decrease_energy(q, torque, coordinates, energy_J))
      break;
  }
  in.place(q);
  Rest rest;
  rest.unbalanced_Nm = in.torque_Nm(in.movable(q, in.torque_Nm)).norm();
  for (const JointReading& joint : q) rest.pose.push_back(joint.position);
  rest.tension_N.assign(in.force_N.begin(), in.force_N.end());
  return rest;
}

VectorXd Equilibrium::torque_Nm(std::span<const double> shaft_rad, const Pose& pose) {
  implementation_->shaft_rad = shaft_rad;
  implementation_->place(implementation_->at(pose));
  return implementation_->torque_Nm;
}

MatrixXd Equilibrium::compliance_rad_per_Nm(std::span<const double> shaft_rad, const Pose& pose) {
  const VectorXd torque = torque_Nm(shaft_rad, pose);
  const Joints q = implementation_->at(pose);
  const auto coordinates = implementation_->movable(q, torque);
  MatrixXd compliance = MatrixXd::Zero(torque.size(), torque.size());
  const MatrixXd stiffness = implementation_->slope(q, torque, coordinates);
  compliance(coordinates, coordinates) = MatrixXd(stiffness.partialPivLu().inverse());
  return compliance;
}

}  // namespace sim

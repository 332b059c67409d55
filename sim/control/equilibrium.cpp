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

struct Equilibrium::Inside {
  Inside(const erp::Robot& robot, std::span<const double> longer_m) : model(robot) {
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
  Joints turned(Joints q, const VectorXd& u) const {
    for (std::size_t j = 0; j < q.size(); ++j) {
      std::array<double, 3> way{};
      for (int d = 0; d < coordinates_of(q[j].type); ++d)
        way[static_cast<std::size_t>(d)] = u[first_of(j) + d];
      q[j].position = displaced(q[j].type, q[j].position, way);
    }
    return q;
  }
  Joints within_range(Joints q) const {
    for (std::size_t j = 0; j < q.size(); ++j)
      if (q[j].type == erp::JointType::revolute)
        q[j].position[0] = std::clamp(q[j].position[0], joint(j).min_rad, joint(j).max_rad);
    return q;
  }

  /// The coordinates that are not held by a stop under these torques.
  std::vector<Index> movable(const Joints& q, const VectorXd& torque) const {
    std::vector<Index> found;
    for (std::size_t j = 0; j < q.size(); ++j) {
      const double angle = q[j].position[0];
      const auto pressed = [&] {
        const double up = -torque[first_of(j)];  // downhill
        return (angle >= joint(j).max_rad && up > 0) || (angle <= joint(j).min_rad && up < 0);
      };
      if (q[j].type == erp::JointType::revolute && pressed()) continue;
      for (int d = 0; d < coordinates_of(q[j].type); ++d) found.push_back(first_of(j) + d);
    }
    return found;
  }

  /// ∂(τ_G + Lᵀ f)/∂q for some of the coordinates; symmetric where the torques are zero.
  MatrixXd slope(const Joints& q, const VectorXd& torque, const std::vector<Index>& among) {
    constexpr double step_rad = 1e-6;
    const auto n = static_cast<Index>(among.size());
    MatrixXd found(n, n);
    for (Index c = 0; c < n; ++c) {
      VectorXd u = VectorXd::Zero(torque.size());
      u[among[static_cast<std::size_t>(c)]] = step_rad;
      place(turned(q, u));
      found.col(c) = (torque_Nm - torque)(among) / step_rad;
    }
    return (found + found.transpose()) / 2;
  }

  /// Limits hinges to their ranges.
  Joints at(const Pose& pose) const {
    Joints q;
    for (std::size_t j = 0; j < pose.size(); ++j)
      q.push_back({.type = joint(j).type, .position = pose[j]});
    return within_range(std::move(q));
  }

  /// One step that decreases V; returns false if none does.
  bool go_down(Joints& q, const VectorXd& torque, const std::vector<Index>& among,
               double& energy_J);

  Musculoskeletal model;
  std::vector<TendonLaw> laws;
  std::span<const double> shaft_rad;
  double damping = 0;  ///< of steps, Nm/rad
  VectorXd torque_Nm, gravity_Nm, force_N;
};

bool Equilibrium::Inside::go_down(Joints& q, const VectorXd& torque,
                                  const std::vector<Index>& among, double& energy_J) {
  const MatrixXd stiff = slope(q, torque, among);
  const double scale = stiff.diagonal().cwiseAbs().maxCoeff();
  const auto n = static_cast<Index>(among.size());
  for (int tries = 0; tries < 40; ++tries) {
    const Eigen::LLT<MatrixXd> solver(stiff + damping * MatrixXd::Identity(n, n));
    if (solver.info() == Eigen::Success) {
      VectorXd u = VectorXd::Zero(torque.size());
      u(among) = -solver.solve(VectorXd(torque(among)));
      u *= std::min(1.0, 0.5 / u.cwiseAbs().maxCoeff());  // chosen: small enough to count turns
      const Joints next = within_range(turned(q, u));
      const double there_J = place(next);
      if (there_J <= energy_J) {
        q = next, energy_J = there_J, damping = damping > 1e-9 * scale ? damping / 10 : 0;
        return true;
      }
    }
    damping = std::max(4 * damping, 1e-6 * scale);
  }
  return false;
}

Equilibrium::Equilibrium(const erp::Robot& robot, std::span<const double> longer_m)
    : inside_(std::make_unique<Inside>(robot, longer_m)) {}
Equilibrium::~Equilibrium() = default;
Equilibrium::Equilibrium(Equilibrium&&) noexcept = default;

Rest Equilibrium::find(std::span<const double> shaft_rad, const Pose& from) {
  constexpr int most_steps = 100;
  constexpr double balanced_Nm = 1e-8;
  Inside& in = *inside_;
  in.shaft_rad = shaft_rad, in.damping = 0;
  Joints q = in.at(from);
  double energy_J = in.place(q);
  for (int k = 0; k < most_steps; ++k) {
    const VectorXd torque = in.torque_Nm;
    const auto among = in.movable(q, torque);
    if (torque(among).norm() < balanced_Nm || !in.go_down(q, torque, among, energy_J)) break;
  }
  in.place(q);
  Rest rest;
  rest.unbalanced_Nm = in.torque_Nm(in.movable(q, in.torque_Nm)).norm();
  for (const JointReading& joint : q) rest.pose.push_back(joint.position);
  rest.tension_N.assign(in.force_N.begin(), in.force_N.end());
  return rest;
}

VectorXd Equilibrium::torque_Nm(std::span<const double> shaft_rad, const Pose& pose) {
  inside_->shaft_rad = shaft_rad;
  inside_->place(inside_->at(pose));
  return inside_->torque_Nm;
}

MatrixXd Equilibrium::compliance_rad_per_Nm(std::span<const double> shaft_rad, const Pose& pose) {
  const VectorXd torque = torque_Nm(shaft_rad, pose);
  const Joints q = inside_->at(pose);
  const auto among = inside_->movable(q, torque);
  MatrixXd compliance = MatrixXd::Zero(torque.size(), torque.size());
  const MatrixXd stiff = inside_->slope(q, torque, among);
  compliance(among, among) = MatrixXd(stiff.partialPivLu().inverse());
  return compliance;
}

}  // namespace sim

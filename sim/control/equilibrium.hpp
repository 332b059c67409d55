#pragma once
#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "sim/model/skeleton/joint_path.hpp"

/// Equilibrium pose of a robot with fixed shaft angles: the minimum of
///
///   V(q) = V_G(q) + Σ E_a(Δx_a),   Δx_a = l_a(q) − rest_a + r_a θ_a
///   0 = τ_G + Lᵀ f,   f_a = dE_a/dΔx_a
///
/// found by Newton's method with numerical derivatives of the torques and Levenberg–Marquardt
/// damping. Hinges stop at the ends of their ranges.
/// Ignores friction, which may hold a robot away from this pose, and contacts between bones.
namespace sim {

struct Rest {
  Pose pose;
  std::vector<double> tension_N;  ///< by actuator
  double unbalanced_Nm = 0;       ///< residual torque at the end of the search, without stops
};

class Equilibrium {
 public:
  /// `longer_m`: additional path length per actuator relative to robot.xml (the paper's L_K0);
  /// empty: zero. Throws std::invalid_argument like Musculoskeletal, and for a robot with free
  /// bodies.
  explicit Equilibrium(const erp::Robot& robot, std::span<const double> longer_m = {});
  ~Equilibrium();
  Equilibrium(Equilibrium&&) noexcept;

  /// `shaft_rad`: by actuator, positive: wound up. The search starts at `from` and decreases V.
  Rest find(std::span<const double> shaft_rad, const Pose& from);
  /// τ_G + Lᵀ f in a pose, Nm; zero in equilibrium.
  Eigen::VectorXd torque_Nm(std::span<const double> shaft_rad, const Pose& pose);
  /// Compliance −∂q/∂τ in a pose, rad/Nm; zero for joints at their stops.
  Eigen::MatrixXd compliance_rad_per_Nm(std::span<const double> shaft_rad, const Pose& pose);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace sim

#pragma once
#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "sim/model/skeleton/joint_path.hpp"

/// Where a robot comes to rest when its shafts are held: the least of
///
///   V(q) = V_G(q) + Σ E_a(Δx_a),   Δx_a = l_a(q) − rest_a + r_a θ_a
///   0 = τ_G + Lᵀ f,   f_a = dE_a/dΔx_a
///
/// by Newton steps, the slope of the torques by difference quotients, damped where V would rise
/// (Levenberg, Marquardt). Hinges stop at the ends of their ranges.
/// Ignores friction, which may hold a robot beside this place, and contacts of bones.
namespace sim {

struct Rest {
  Pose pose;
  std::vector<double> tension_N;  ///< by actuator
  double left_Nm = 0;             ///< of the torques, stops apart: not balanced where it gave up
};

class Equilibrium {
 public:
  /// `longer_m`, by actuator, none: as if paths were longer by that much than robot.xml has it at
  /// the start (the paper's L_K0). Throws std::invalid_argument as Musculoskeletal does, and for a
  /// robot with free bodies.
  explicit Equilibrium(const erp::Robot& robot, std::span<const double> longer_m = {});
  ~Equilibrium();
  Equilibrium(Equilibrium&&) noexcept;

  /// Shaft angles by actuator, positive wound up; the search goes down from `from`.
  Rest find(std::span<const double> shaft_rad, const Pose& from);
  /// τ_G + Lᵀ f in a pose, Nm: zero where it rests.
  Eigen::VectorXd torque_Nm(std::span<const double> shaft_rad, const Pose& pose);
  /// How far it gives way there, −∂q/∂τ, rad/Nm; nothing at stops that hold.
  Eigen::MatrixXd compliance_rad_per_Nm(std::span<const double> shaft_rad, const Pose& pose);

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace sim

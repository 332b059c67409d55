#pragma once
#include <memory>
#include <vector>

#include "sim/model/skeleton/joint_path.hpp"

/// Statics: which tensions hold a pose, and how long the lines are then.
///
///   min ½ Σ (f − f_rest)² + ½ |τ_G + Jᵀ f|²/ε,  J = ∂L/∂q,  f ≥ f_min                       (1)
///   line change = L_T(q) − L_T(q0) − (Δx(f) − Δx(f0))
///
/// q0, f0: the robot's starting pose and pretensions. With the lines at these lengths the tendons
/// pull with f at q, so the pose is an equilibrium of length control.
/// ε is so small that the pose is held wherever tensions can; where they cannot, (1) still has one
/// answer. Solved on the dual: f = max(f_min, f_rest + J λ), τ_G + Jᵀ f = −ε λ, by Newton steps in λ.
namespace sim {

struct HoldingOptions {
  double rest_N = 10;  ///< what each muscle would like to pull; chosen
  double least_N = 5;  ///< no tendon goes slack; chosen
};

struct Holding {
  std::vector<double> tension_N, line_m;  ///< by actuator
  double unbalanced_Nm = 0;               ///< what no tensions can hold; of free bodies in N
};

/// Holds one pose after the other: turns around pulleys are counted from pose to pose, the first
/// from where the robot starts.
class PoseHolder {
 public:
  /// Throws std::invalid_argument as RobotTree and Routing do.
  explicit PoseHolder(const erp::Robot& robot);
  ~PoseHolder();
  /// Throws std::invalid_argument, naming the actuator, where a point of a path lies in its pulley.
  Holding hold(const Pose& pose, const HoldingOptions& options = {});

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

/// One pose. Throws as PoseHolder does.
Holding hold_pose(const erp::Robot& robot, const Pose& pose, const HoldingOptions& options = {});

}  // namespace sim

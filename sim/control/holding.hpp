#pragma once
#include <memory>
#include <vector>

#include "sim/model/skeleton/joint_path.hpp"

/// Statics: tensions that hold a pose, and the corresponding line lengths.
///
///   min ½ Σ (f − f_rest)² + ½ |τ_G + Jᵀ f|²/ε,  J = ∂L/∂q,  f ≥ f_min                       (1)
///   line change = L_T(q) − L_T(q0) − (Δx(f) − Δx(f0))
///
/// q0, f0: the robot's starting pose and pretensions. With these line lengths the tensions at q are
/// f. The pose is then an equilibrium under length control. ε is so small that the pose is held if
/// tensions exist that hold it; otherwise (1) still has a unique solution. Solved on the dual: f =
/// max(f_min, f_rest + J λ), τ_G + Jᵀ f = −ε λ, by Newton steps in λ.
namespace sim {

struct HoldingOptions {
  double rest_N = 10;  ///< preferred tension of each muscle; chosen
  double least_N = 5;  ///< lower bound, which keeps tendons taut; chosen
};

struct Holding {
  std::vector<double> tension_N, line_m;  ///< by actuator
  double unbalanced_Nm = 0;  ///< residual torque that no tensions can hold; N for free bodies
};

/// Computes the holding tensions of successive poses. Turns around pulleys are counted from pose to
/// pose, beginning with the starting pose.
class PoseHolder {
 public:
  /// Throws std::invalid_argument like RobotTree and Routing.
  explicit PoseHolder(const erp::Robot& robot);
  ~PoseHolder();
  /// Throws std::invalid_argument, with the actuator's name, if a path point lies inside a pulley.
  Holding hold(const Pose& pose, const HoldingOptions& options = {});

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// For a single pose. Throws like PoseHolder.
Holding hold_pose(const erp::Robot& robot, const Pose& pose, const HoldingOptions& options = {});

}  // namespace sim

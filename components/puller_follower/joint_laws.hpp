#pragma once
#include <Eigen/Core>
#include <memory>

#include "sim/control/loop_shaping/joint_loops.hpp"
#include "sim/model/actuator/musculoskeletal.hpp"

/// Torques from measured and desired joint motion: step 1 of puller-follower control. All vectors
/// are by coordinate of the model.
namespace control {

enum class Law {
  linearised,  ///< input–output linearisation: τ = H (a_d + k_d ė + k_p e + k_i ∫ e) + C + τ_G
  loop_shaping,  ///< H-infinity loop shaping: τ = K e + w_G τ_G + w_a H a_d,  joint_loops.hpp
  pd  ///< for comparison: τ = H₀ (k_p e + k_d ė) + w_G τ_G, H₀: diagonal of H at the start
};

/// Gains of the laws; described in PullerFollower::Params.
struct LawParams {
  double kp_per_s2 = 225, kd_per_s = 30, ki_per_s3 = 1000;
  double integral_rad_s = 0.1;
  double gravity = 1;
  double feedforward = 1;
  sim::loop_shaping::JointShape shape;
};

/// Desired motion and joint errors.
struct JointErrors {
  Eigen::VectorXd error_rad, error_rad_per_s;  ///< desired minus measured
  Eigen::VectorXd desired_rad_per_s, desired_rad_per_s2;
  explicit JointErrors(int n)
      : error_rad(Eigen::VectorXd::Zero(n)),
        error_rad_per_s(error_rad),
        desired_rad_per_s(error_rad),
        desired_rad_per_s2(error_rad) {}
};

/// Dynamics of the skeleton in the current posture: H, C + τ_G and τ_G.
struct Dynamics {
  Eigen::MatrixXd inertia;
  Eigen::VectorXd bias, gravity;
  explicit Dynamics(int n)
      : inertia(n, n), bias(Eigen::VectorXd::Zero(n)), gravity(Eigen::VectorXd::Zero(n)) {}
  void update(sim::SkeletonModel& skeleton) {
    skeleton.inertia(inertia), skeleton.bias(bias), skeleton.gravity_torques(gravity);
  }
};

class JointLaw {
 public:
  virtual ~JointLaw() = default;
  /// Starts control at the current torque, in Nm: the integral state starts at its difference from
  /// the skeleton's torque. No heap.
  virtual void begin(const Eigen::VectorXd& torque_Nm, const Dynamics& dynamics) = 0;
  /// τ without joint friction, in Nm. No heap.
  virtual const Eigen::VectorXd& torque_Nm(const JointErrors& errors, const Dynamics& dynamics,
                                           double dt_s) = 0;
};

/// `model`: the robot in its starting posture. Throws std::invalid_argument if the loops cannot be
/// stabilised.
std::unique_ptr<JointLaw> law_of(Law law, const LawParams& params, sim::Musculoskeletal& model);

}  // namespace control

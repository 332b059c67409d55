#pragma once
#include <Eigen/Core>
#include <memory>

#include "sim/model/actuator/musculoskeletal.hpp"
#include "sim/control/loop_shaping/joint_loops.hpp"

/// From where hinges are and should be to their torques: the first step of puller-follower control.
/// All by coordinate of the model.
namespace control {

enum class Law {
  linearised,  ///< input–output linearisation: τ = H (a_d + k_d ė + k_p e + k_i ∫ e) + C + τ_G
  loop_shaping,  ///< H-infinity loop shaping: τ = K e + w_G τ_G + w_a H a_d,  joint_loops.hpp
  pd  ///< for comparison: τ = H₀ (k_p e + k_d ė) + w_G τ_G, H₀ diagonal, of the start
};

struct LawParams {
  double kp_per_s2 = 225, kd_per_s = 30,
         ki_per_s3 = 1000;      ///< (15 /s)², critically damped; chosen. Not of loop_shaping
  double integral_rad_s = 0.1;  ///< ∫ e is kept within; chosen
  double gravity = 1;           ///< w_G, share of gravity that is compensated on line
  double feedforward = 1;       ///< w_a, share of the wanted acceleration's torque
  sim::loop_shaping::JointShape shape;
};

/// What is wanted, and how far the joints are from it.
struct JointErrors {
  Eigen::VectorXd error_rad, error_rad_per_s;  ///< wanted less measured
  Eigen::VectorXd wanted_rad_per_s, wanted_rad_per_s2;
  explicit JointErrors(int n)
      : error_rad(Eigen::VectorXd::Zero(n)),
        error_rad_per_s(error_rad),
        wanted_rad_per_s(error_rad),
        wanted_rad_per_s2(error_rad) {}
};

/// What the bones ask for in the posture at hand: H, C + τ_G and τ_G.
struct Dynamics {
  Eigen::MatrixXd inertia;
  Eigen::VectorXd bias, gravity;
  explicit Dynamics(int n)
      : inertia(n, n), bias(Eigen::VectorXd::Zero(n)), gravity(Eigen::VectorXd::Zero(n)) {}
  void take(sim::SkeletonModel& skeleton) {
    skeleton.inertia(inertia), skeleton.bias(bias), skeleton.gravity_torques(gravity);
  }
};

class JointLaw {
 public:
  virtual ~JointLaw() = default;
  /// Control begins with the torque that acts, Nm: what it sums up starts at what that has beyond
  /// the bones' own. No heap.
  virtual void begin(const Eigen::VectorXd& torque_Nm, const Dynamics& dynamics) = 0;
  /// τ, without joint friction, Nm. No heap.
  virtual const Eigen::VectorXd& torque_Nm(const JointErrors& errors, const Dynamics& dynamics,
                                           double dt_s) = 0;
};

/// `model`: where the robot starts. Throws std::invalid_argument where no such loops can be closed.
std::unique_ptr<JointLaw> law_of(Law law, const LawParams& params, sim::Musculoskeletal& model);

}  // namespace control

#pragma once
#include <optional>
#include <string>

#include "components/joints/joints.hpp"
#include "components/node/run.hpp"
#include "components/puller_follower/antagonists.hpp"
#include "sim/actuator/musculoskeletal.hpp"

/// Puller-follower control of a hinge with two antagonists (paper, 5.2 and Fig. 7a): the puller
/// answers for the joint's angle, the follower for its own tension; the two change roles.
///
/// Input–output linearisation by a compensator of two steps:
///
///   1  angle → torque    τ = H (a_d + k_d (v_d − v) + k_p e + k_i ∫ e dt) + C + τ_G + τ_f(v_d)
///   2  tension → voltage  of both motors, with F_d of puller and follower: antagonists.hpp
///
/// The derivatives of F_d are those of the first step, smoothed over `smooth_s`.
namespace control {

class PullerFollower {
 public:
  struct Params {
    double low_N = 4,
           high_N = 15;         ///< reference tension away from and at a change of roles; chosen
    double width_Nm = 0.15;     ///< of the torque, around a change; chosen
    double lead_s = 0.3;        ///< how long before the change; chosen
    double raise_N_per_s = 40;  ///< how fast it rises and falls: the line that takes; chosen
    double smooth_s = 0.01;     ///< chosen
    double kp_per_s2 = 225, kd_per_s = 30,
           ki_per_s3 = 1000;      ///< (15 /s)², critically damped; chosen
    double integral_rad_s = 0.1;  ///< ∫ e is kept within; chosen
    double friction = 1;          ///< share of robot.xml's joint friction that is compensated
    double tension_per_s = 60;    ///< b of the tensions; chosen
    std::string source = "sim";   ///< whose joint_state is believed
    double stale_s = 0.05;        ///< older states and targets are no longer followed; chosen
    void visit(auto& v) {
      v("low_N", low_N, xml::at_least_zero);
      v("high_N", high_N, xml::at_least_zero);
      v("width_Nm", width_Nm, xml::positive);
      v("lead_s", lead_s, xml::at_least_zero);
      v("raise_N_per_s", raise_N_per_s, xml::positive);
      v("smooth_s", smooth_s, xml::positive);
      v("kp_per_s2", kp_per_s2, xml::at_least_zero);
      v("kd_per_s", kd_per_s, xml::at_least_zero);
      v("ki_per_s3", ki_per_s3, xml::at_least_zero);
      v("integral_rad_s", integral_rad_s, xml::at_least_zero);
      v("friction", friction, xml::at_least_zero);
      v("tension_per_s", tension_per_s, xml::positive);
      v("source", source);
      v("stale_s", stale_s, xml::positive);
    }
  };

  /// Throws std::invalid_argument where the robot is no single hinge with two antagonists.
  PullerFollower(const Params& params, const erp::Robot& robot);

  bool wants(const erp::JointState& state) const { return params_.source == state.source; }
  /// Nothing while joint, tendons or target are not known or stale: the plant then takes its safe
  /// action.
  std::optional<erp::ActuatorCommand> step(const erp::SensorFrame& frame, double dt_s,
                                           const node::Latest<erp::JointState>& state,
                                           const node::Latest<erp::JointTarget>& target);

 private:
  struct Tendon {
    std::size_t actuator;
    TensionLinearisation law;
    double tension_N = 0, shaft_rad = 0, speed_rad_per_s = 0;
    bool seen = false;
  };
  /// A signal and its smoothed derivatives.
  struct Smooth {
    double value = 0, rate = 0, acceleration = 0;
    void follow(double to, double dt_s, double smooth_s);
  };
  Tendon tendon_of(const erp::Robot& robot, bool positive) const;
  bool hear(const erp::SensorFrame& frame, double dt_s);
  double torque_Nm(double dt_s);
  erp::ActuatorCommand command(const erp::SensorFrame& frame);

  Params params_;
  erp::Robot robot_;
  joints::Names names_;
  sim::Musculoskeletal model_;
  std::array<Tendon, 2> tendons_;
  std::vector<sim::JointReading> now_;
  std::vector<sim::JointMotion> wanted_;
  Eigen::MatrixXd inertia_;
  Eigen::VectorXd bias_;
  Smooth torque_, reference_;
  double raised_N_ = 0, integral_rad_s_ = 0, acceleration_rad_per_s2_ = 0;
  bool driving_ = false;
};

}  // namespace control

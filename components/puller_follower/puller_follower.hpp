#pragma once
#include <Eigen/Cholesky>
#include <optional>
#include <string>

#include "components/joints/joints.hpp"
#include "components/node/run.hpp"
#include "components/puller_follower/joint_drive.hpp"
#include "components/puller_follower/joint_laws.hpp"
#include "components/puller_follower/unmodelled.hpp"

/// Puller-follower control of hinges with two antagonists each (paper, 5.2 and Fig. 7): the puller
/// answers for the joint's angle, the follower for its own tension; the two change roles.
///
///   1  angles → torques    a law of joint_laws.hpp, and the joints' friction at the wanted speed
///   2  torque → voltages   of both motors, joint by joint: joint_drive.hpp, antagonists.hpp
///
/// The second step needs how the joints are about to move: a = H⁻¹ (τ − C − τ_G − τ_f) and what else
/// they seem to accelerate by, unmodelled.hpp: under a load tendons would go slack without it.
///
/// Control begins from where the joints are, as they move and with the torque that acts, and leads
/// them onto the target: at first, when frames have been missing, and when a tendon has hung slack.
/// While one hangs, which the plant then takes up, the joints are held where that began. A joint that
/// outruns its motors, under a load or after a machine stood still, is braked until all are at rest:
/// a loop around motors that cannot follow would swing it from stop to stop.
namespace control {

class PullerFollower {
 public:
  struct Params {
    xml::Place place;
    Law law = Law::linearised;
    std::string loops;  ///< of loop_shaping: a file of JointShape, relative to the config; its
                        ///< smooth_s counts then
    LawParams laws;
    DriveParams drives;
    double friction = 1;           ///< share of robot.xml's joint friction that is compensated
    std::string source = "sim";    ///< whose joint_state is believed
    double stale_s = 0.05;         ///< older states and targets are no longer followed; chosen
    double start_rad_per_s = 0.5;  ///< about how fast joints are led onto the target; chosen
    void visit(auto& v) {
      v("law", law);
      v("low_N", drives.low_N, xml::at_least_zero);
      v("high_N", drives.high_N, xml::at_least_zero);
      v("width_Nm", drives.width_Nm, xml::positive);
      v("lead_s", drives.lead_s, xml::at_least_zero);
      v("raise_N_per_s", drives.raise_N_per_s, xml::positive);
      v("raise_s", drives.raise_s, xml::positive);
      v("smooth_s", drives.smooth_s, xml::positive);
      v("brake_s", drives.brake_s, xml::at_least_zero);
      v("tension_per_s", drives.tension_per_s, xml::positive);
      v("kp_per_s2", laws.kp_per_s2, xml::at_least_zero);
      v("kd_per_s", laws.kd_per_s, xml::at_least_zero);
      v("ki_per_s3", laws.ki_per_s3, xml::at_least_zero);
      v("integral_rad_s", laws.integral_rad_s, xml::at_least_zero);
      v("gravity", laws.gravity, xml::at_least_zero);
      v("feedforward", laws.feedforward, xml::at_least_zero);
      v("loops", loops);
      v("friction", friction, xml::at_least_zero);
      v("source", source);
      v("stale_s", stale_s, xml::positive);
      v("start_rad_per_s", start_rad_per_s, xml::positive);
    }
  };

  /// Throws std::invalid_argument as hinges_of, JointDrive and law_of.
  PullerFollower(const Params& params, const erp::Robot& robot);
  /// As a component: it says when it brakes.
  PullerFollower(const Params& params, const erp::Robot& robot, node::Node& node)
      : PullerFollower(params, robot) {
    node_ = &node;
  }

  bool wants(const erp::JointState& state) const { return params_.source == state.source; }
  /// Nothing while joints, tendons or target are not known or stale: the plant then takes its safe
  /// action. No heap from the second step on.
  std::optional<erp::ActuatorCommand> step(const erp::SensorFrame& frame, double dt_s,
                                           const node::Latest<erp::JointState>& state,
                                           const node::Latest<erp::JointTarget>& target);

 private:
  enum class Phase { silent, brakes, holds, leads };
  bool hear(const erp::SensorFrame& frame, double dt_s);
  Phase next() const;
  erp::ActuatorCommand brake(bool goes_on, double dt_s);
  void say_outrun() const;
  erp::ActuatorCommand lead(bool goes_on, double dt_s);
  void begin();
  void compare();
  void find_torques(double dt_s);
  void find_acceleration(double dt_s);

  Params params_;
  joints::Names names_;
  sim::Musculoskeletal model_;
  std::vector<sim::loop_shaping::Hinge> hinges_;
  std::vector<JointDrive> drives_;
  std::unique_ptr<JointLaw> law_;
  std::vector<sim::JointReading> now_;
  std::vector<sim::JointMotion> wanted_, held_;
  JointErrors errors_;
  Dynamics dynamics_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
  Eigen::VectorXd acting_Nm_, torque_Nm_, friction_Nm_;  ///< by the tendons, asked for, of joints
  Eigen::VectorXd acceleration_;
  Unmodelled unmodelled_;
  Phase phase_ = Phase::silent;
  sim::CatchUp onto_target_;
  double led_s_ = 0, rested_s_ = 0;  ///< since it began; while it brakes
  node::Node* node_ = nullptr;
};

}  // namespace control

template <>
struct xml::Names<control::Law> {
  static constexpr auto list = std::to_array<std::pair<const char*, control::Law>>(
      {{"linearised", control::Law::linearised},
       {"loop_shaping", control::Law::loop_shaping},
       {"pd", control::Law::pd}});
};

#pragma once
#include <Eigen/Cholesky>
#include <optional>
#include <string>

#include "components/joints/joints.hpp"
#include "components/node/run.hpp"
#include "components/puller_follower/disturbance_observer.hpp"
#include "components/puller_follower/joint_drive.hpp"
#include "components/puller_follower/joint_laws.hpp"

/// Puller-follower control of hinges with two antagonists each (paper, 5.2 and Fig. 7): the puller
/// controls the joint's angle, the follower its own tension; the two change roles.
///
///   1  angles → torques    a law of joint_laws.hpp, plus joint friction at the desired speed
///   2  torque → voltages   of both motors of each joint: joint_drive.hpp, antagonists.hpp
///
/// Step 2 needs the joints' accelerations: a = H⁻¹ (τ − C − τ_G − τ_f) plus the estimate of
/// disturbance_observer.hpp. Without that estimate tendons would go slack under a load.
///
/// Control starts at the current joint positions, velocities and torques, and guides the joints to
/// the target. It restarts after missing frames and after a tendon was slack. While a tendon is
/// slack, the plant winds it up, and the joints are held. A joint whose motors saturate, under a
/// load or after the computer stalled, is braked until all joints are at rest: a closed loop with
/// saturated motors would oscillate between the joint stops.
namespace control {

class PullerFollower {
 public:
  struct Params {
    xml::Place place;
    Law law = Law::linearised;
    std::string loops;
    LawParams laws;
    DriveParams drives;
    double friction = 1;
    std::string source = "sim";
    double stale_s = 0.05;
    double start_rad_per_s = 0.5;
    void visit(auto& v) {
      v("law", law,
        "Law from joint angles to torques: input-output linearisation, H-infinity loop shaping, or "
        "PD for comparison.");
      v("low_N", drives.low_N,
        {xml::at_least_zero, "Reference tension of a pair away from a change of roles; chosen."});
      v("high_N", drives.high_N,
        {xml::at_least_zero, "Reference tension of a pair around a change of roles; chosen."});
      v("width_Nm", drives.width_Nm, {xml::positive, "Torque range of a change of roles; chosen."});
      v("lead_s", drives.lead_s,
        {xml::at_least_zero,
         "Time before a change of roles at which the reference tension begins to rise; chosen."});
      v("raise_N_per_s", drives.raise_N_per_s,
        {xml::positive, "Largest rate of the reference tension; chosen."});
      v("raise_s", drives.raise_s,
        {xml::positive, "Smoothing time of the reference tension; chosen."});
      v("smooth_s", drives.smooth_s,
        {xml::positive,
         "Smoothing time of the torque; chosen. loop_shaping uses smooth_s of its file instead."});
      v("brake_s", drives.brake_s,
        {xml::at_least_zero,
         "Damping g of the brake: the lines yield by g times the rate at which the joint pulls "
         "them out; chosen."});
      v("tension_per_s", drives.tension_per_s,
        {xml::positive,
         "Bandwidth b of the tensions; the delay to the motor limits it to about 60 /s; chosen."});
      v("kp_per_s2", laws.kp_per_s2,
        {xml::at_least_zero,
         "Gain k_p of the joint error, (15 /s)², critically damped with kd_per_s; chosen. Not used "
         "by loop_shaping."});
      v("kd_per_s", laws.kd_per_s,
        {xml::at_least_zero,
         "Gain k_d of the error of the joint velocity; chosen. Not used by loop_shaping."});
      v("ki_per_s3", laws.ki_per_s3,
        {xml::at_least_zero,
         "Gain k_i of the integral of the joint error; chosen. Used by linearised only."});
      v("integral_rad_s", laws.integral_rad_s,
        {xml::at_least_zero,
         "Limit of the magnitude of the integral of the joint error; chosen. Used by linearised "
         "only."});
      v("gravity", laws.gravity,
        {xml::at_least_zero,
         "Share w_G of the torques of gravity that is compensated; 1: all. Not used by "
         "linearised."});
      v("feedforward", laws.feedforward,
        {xml::at_least_zero,
         "Share w_a of the torques of the desired acceleration that is commanded; loop_shaping "
         "only."});
      v("loops", loops,
        "Weights of loop_shaping: a <loops> file, relative to the config; empty: its defaults.");
      v("friction", friction,
        {xml::at_least_zero,
         "Share of the joint friction of robot.xml that is compensated; 1: all."});
      v("source", source,
        "Component whose joint_state is used: sim, pose_estimator or motion_capture.");
      v("stale_s", stale_s,
        {xml::positive, "Age from which joint states and targets are rejected; chosen."});
      v("start_rad_per_s", start_rad_per_s,
        {xml::positive,
         "Approximate speed of the approach to the target at the start and after a gap; chosen."});
    }
  };

  /// Throws std::invalid_argument as hinges_of, JointDrive and law_of.
  PullerFollower(const Params& params, const erp::Robot& robot);
  /// As a component, which reports when it brakes.
  PullerFollower(const Params& params, const erp::Robot& robot, node::Node& node)
      : PullerFollower(params, robot) {
    node_ = &node;
  }

  bool accepts(const erp::JointState& state) const { return params_.source == state.source; }
  /// nullopt if joints, tendons or target are unknown or stale: the plant then takes its safe
  /// action. No heap from the second step on.
  std::optional<erp::ActuatorCommand> step(const erp::SensorFrame& frame, double dt_s,
                                           const node::Latest<erp::JointState>& state,
                                           const node::Latest<erp::JointTarget>& target);

 private:
  enum class Phase { idle, braking, holding, tracking };
  bool read_sensors(const erp::SensorFrame& frame, double dt_s);
  Phase next_phase() const;
  erp::ActuatorCommand brake(bool continues, double dt_s);
  void report_saturation() const;
  erp::ActuatorCommand track(bool continues, double dt_s);
  void begin();
  void update_errors();
  void compute_torques(double dt_s);
  void compute_acceleration(double dt_s);

  Params params_;
  joints::Names names_;
  sim::Musculoskeletal model_;
  std::vector<sim::loop_shaping::Hinge> hinges_;
  std::vector<JointDrive> drives_;
  std::unique_ptr<JointLaw> law_;
  std::vector<sim::JointReading> measured_;
  std::vector<sim::JointMotion> desired_, holding_pose_;
  JointErrors errors_;
  Dynamics dynamics_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
  /// Torques: of the tendons, commanded, of joint friction.
  Eigen::VectorXd acting_Nm_, torque_Nm_, friction_Nm_;
  Eigen::VectorXd acceleration_;
  DisturbanceObserver disturbance_;
  Phase phase_ = Phase::idle;
  sim::CatchUp catch_up_;
  double tracking_s_ = 0, rest_s_ = 0;  ///< time since tracking began; time at rest while braking
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

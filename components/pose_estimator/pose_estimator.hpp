#pragma once
#include "components/joints/joints.hpp"
#include "components/node/run.hpp"
#include "components/pose_estimator/pose_filter.hpp"
#include "sim/model/actuator/tendon.hpp"

/// Estimates the pose from the actuators' sensors (paper, 2.3): joint_state from sensor_frame.
///
///   l̂_a = L_R + L_K0 − r θ + Δx,   f(Δx) = F − D (dl/dt + r ω)       eqs 1, 2, 4, solved for l
///
/// from encoder and force sensor. Slack tendons are skipped. The variance of a length is
///
///   σ_l² = (σ_F / f′)² + σ_θ² r² + σ_model²        noise of robot.xml's sensors, and `model_m`
///
/// Tendons whose encoder has no known zero are skipped.
namespace pose {

class PoseEstimator {
 public:
  struct Params : FilterOptions {
    double model_m = 0.0002;
    double slack_N = 1;
    bool joint_sensors = false;
    double capture_rad = 0;
    bool imus = false;
    double acceleration_sigma_m_per_s2 = 3;
    void visit(auto& v) {
      v.former("jerked_m_per_s2", "acceleration_sigma_m_per_s2");
      v("acceleration_rad_per_s2", acceleration_rad_per_s2,
        {xml::positive,
         "Standard deviation σ_a of the acceleration that is not modelled; chosen."});
      v("start_rad", start_rad,
        {xml::positive, "Standard deviation of the initial joint angles; chosen."});
      v("start_rad_per_s", start_rad_per_s,
        {xml::positive, "Standard deviation of the initial joint velocities; chosen."});
      v("gate", gate,
        {xml::positive,
         "Innovation, in standard deviations, beyond which a measurement is rejected; chosen."});
      v("model_m", model_m,
        {xml::at_least_zero,
         "Standard deviation σ_model of the error of the tendon's law and routing; chosen."});
      v("slack_N", slack_N,
        {xml::at_least_zero, "Tension below which a tendon is skipped; chosen."});
      v("joint_sensors", joint_sensors, "Whether joint sensors are also used.");
      v("capture_rad", capture_rad,
        {xml::at_least_zero, "Standard deviation of motion_capture's joint_state; 0: not used."});
      v("imus", imus, "Whether inertial units are also used.");
      v("acceleration_sigma_m_per_s2", acceleration_sigma_m_per_s2,
        {xml::positive,
         "Standard deviation of the acceleration of inertial units without gravity; chosen."});
    }
  };

  static constexpr bool asynchronous_joint_state = true;  ///< motion_capture's joint_state

  /// Throws std::invalid_argument for an inertial unit on a body that does not exist.
  PoseEstimator(const Params& params, const erp::Robot& robot);

  bool accepts(const erp::JointState& state) const {
    return params_.capture_rad > 0 && std::string_view(state.source) == "motion_capture";
  }
  erp::JointState step(const erp::SensorFrame& frame, double dt_s,
                       const node::Latest<erp::JointState>& capture,
                       const node::Latest<erp::ImuFrame>& imus);

  const PoseFilter& filter() const { return filter_; }

 private:
  struct Tendon {
    std::string name;
    sim::TendonLaw law;
    double tension_sigma_N, shaft_sigma_rad;
    double tension_N = 0, shaft_rad = 0, speed_rad_per_s = 0;
    bool is_measured = false;
  };
  void read_sensors(const erp::SensorFrame& frame, double dt_s);
  void update_from_tendons();
  void update_from_joints(const erp::SensorFrame& frame);
  void update_from_capture(const node::Latest<erp::JointState>& capture);
  void update_from_imus(const node::Latest<erp::ImuFrame>& imus);
  erp::JointState estimate();

  Params params_;
  erp::Robot robot_;
  joints::Names names_;
  PoseFilter filter_;
  std::vector<Tendon> tendons_;
  Eigen::VectorXd tension_N_, length_rate_m_per_s_, variance_rad2_;
  std::vector<sim::JointReading> captured_;
  std::vector<int> imu_bodies_;  ///< by unit of robot.xml
  std::int64_t last_capture_ns_ = 0, last_imu_ns_ = 0;
};

}  // namespace pose

#pragma once
#include <optional>
#include <string>

#include "components/computed_force/jacobian_source.hpp"
#include "components/joints/joints.hpp"
#include "components/node/run.hpp"
#include "sim/control/force_reference.hpp"
#include "sim/control/tension_distribution.hpp"
#include "sim/model/actuator/musculoskeletal.hpp"

/// Computed force control (paper, 5.3 and Fig. 8a):
///
///   a_ref = a_d + k_d (v_d − v) + k_p e + k_i ∫ e dt          e = q_d ⊖ q
///   τ     = H(q) a_ref + C(q, v) + τ_G(q) + τ_f(v_d)          eq. 6; τ_f friction of the joints
///   f     = argmin of a cost, τ = −Lᵀ(q) f, f_min ≤ f ≤ f_max   eqs 7, 8: tension_distribution.hpp
///
/// f are references for the force controllers of the ECUs. For ball joints e, v and a are vectors
/// in the child's frame, so there is no gimbal lock. A tendon whose ECU has tripped enters with its
/// measured tension; the others compensate for it.
namespace control {

class ComputedForce {
 public:
  struct Params {
    xml::Place place;
    sim::TensionObjective objective = sim::TensionObjective::least_tension;
    JacobianKind jacobian = JacobianKind::analytic;
    std::string muscles;
    double least_N = 5;
    double kp_per_s2 = 100;
    double kd_per_s = 20;
    double ki_per_s3 = 0;
    double integral_rad_s = 0.2;
    double friction = 0;
    double lag_compensation = 1;
    double rate_s = 0.02;
    std::string source = "sim";
    double stale_s = 0.05;
    void visit(auto& v) {
      v.former("liking", "objective"), v.former("anticipate", "lag_compensation");
      v("objective", objective,
        "Objective by which the tensions are selected among those that give the torques.");
      v("jacobian", jacobian,
        "Muscle Jacobian: analytic from the routing, network or difference from a learned file, "
        "on_line learned in the run.");
      v("muscles", muscles,
        "Learned Jacobian, a <muscles> file, relative to the config; empty: none.");
      v("least_N", least_N,
        {xml::at_least_zero,
         "Smallest tension f_min of each tendon, so that none goes slack; chosen."});
      v("kp_per_s2", kp_per_s2,
        {xml::at_least_zero,
         "Gain k_p of the joint error, (10 /s)², critically damped with kd_per_s; chosen."});
      v("kd_per_s", kd_per_s,
        {xml::at_least_zero, "Gain k_d of the error of the joint velocity; chosen."});
      v("ki_per_s3", ki_per_s3,
        {xml::at_least_zero, "Gain k_i of the integral of the joint error; 0: none."});
      v("integral_rad_s", integral_rad_s,
        {xml::at_least_zero, "Limit of the magnitude of the integral of the joint error; chosen."});
      v("friction", friction,
        {xml::at_least_zero,
         "Share of the joint friction of robot.xml that is compensated; 1: all."});
      v("lag_compensation", lag_compensation,
        {xml::at_least_zero,
         "Share of the lag of the ECUs' force laws that is compensated; 0: none."});
      v("rate_s", rate_s,
        {xml::at_least_zero, "Smoothing time of the rate of the tensions; chosen."});
      v("source", source,
        "Component whose joint_state is used: sim, pose_estimator or motion_capture.");
      v("stale_s", stale_s,
        {xml::positive, "Age from which joint states and targets are rejected; chosen."});
    }
  };

  /// Throws std::invalid_argument as Musculoskeletal, objective_terms and jacobian_source.
  ComputedForce(const Params& params, const erp::Robot& robot);
  ComputedForce(const ComputedForce&) = delete;
  ComputedForce& operator=(const ComputedForce&) = delete;

  bool accepts(const erp::JointState& state) const { return params_.source == state.source; }
  /// nullopt if joints or target are unknown or stale: the plant then takes its safe action.
  std::optional<erp::ActuatorCommand> step(const erp::SensorFrame& frame, double dt_s,
                                           const node::Latest<erp::JointState>& state,
                                           const node::Latest<erp::JointTarget>& target);

 private:
  using Vector = Eigen::VectorXd;
  void reference_acceleration(double dt_s);
  void add_friction();
  void fix_tripped_tensions(const erp::SensorFrame& frame);
  erp::ActuatorCommand command(const Eigen::MatrixXd& jacobian, const Vector& tension_N,
                               double dt_s);

  Params params_;
  erp::Robot robot_;
  joints::Names names_;
  sim::Musculoskeletal model_;
  std::unique_ptr<JacobianSource> jacobian_source_;
  sim::TensionDistribution distribution_;
  std::vector<sim::JointReading> measured_;
  std::vector<sim::JointMotion> desired_;
  std::vector<sim::ForceReference> force_references_;
  Vector speed_d_, acceleration_d_;  ///< desired values, in the joints' own frames
  Vector acceleration_, integral_, bias_, torque_, last_N_, rate_N_per_s_, line_rate_,
      line_acceleration_;
  Eigen::MatrixXd inertia_;
  bool inputs_were_valid_ = false;
};

}  // namespace control

template <>
struct xml::Names<control::JacobianKind> {
  static constexpr auto list = std::to_array<std::pair<const char*, control::JacobianKind>>(
      {{"analytic", control::JacobianKind::analytic},
       {"network", control::JacobianKind::network},
       {"difference", control::JacobianKind::difference},
       {"on_line", control::JacobianKind::on_line}});
};
template <>
struct xml::Names<sim::TensionObjective> {
  static constexpr auto list = std::to_array<std::pair<const char*, sim::TensionObjective>>(
      {{"least_tension", sim::TensionObjective::least_tension},
       {"least_energy", sim::TensionObjective::least_energy},
       {"least_activation", sim::TensionObjective::least_activation},
       {"smooth", sim::TensionObjective::smooth}});
};

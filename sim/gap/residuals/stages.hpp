#pragma once
#include <array>
#include <functional>
#include <string>
#include <vector>

#include "sim/gap/residuals/explanation.hpp"
#include "sim/gap/residuals/loose_joint.hpp"
#include "sim/model/effects/library.hpp"

/// The residuals of a robot's laws, stage by stage. The chain of an actuator is cut at every
/// measured signal, and the inputs of each stage are the measurements at its ends. Thus an error of
/// one stage does not appear at the next.
///
///   motor     V − R i − L di/dt − K_E N ω                                   (V)
///   gearbox   J_M N² ω̇ − N (K_T ī − µ_M N ω − s τ_CM) + X/e                 (Nm),
///             X = µ_G ω + s τ_CG + r F, e as in motor.hpp
///   tendon    F − [f(Δx) + D dΔx/dt],  Δx from q and θ                       (N)
///   joint     H q̈ + C + τ_G + friction + Σ F ∂L/∂q                          (Nm), for each coordinate
///
/// each as a mean under a window (bump.hpp). Symbols: motor.hpp, tendon.hpp; q, θ: angles of joint
/// and shaft.
///
/// - The current at a row is that at the end of a period of constant voltage (held_voltage.hpp).
/// - Where a joint or a shaft rests or reverses, friction may have any value within a band, and a
///   near stop may push. The residual is then the part beyond the band. The noise that the band
///   hides is added (band.hpp).
/// - Windows in which a shaft or a ball joint rests, or a ball joint is at its stop, are excluded.
/// - Spindle and routing belong to the stage of the tendon, bodies to the stage of the joint.
/// - Without a tension sensor the tension is computed from the spring's law. Errors of the tendon
///   then appear at the stages that use the tension. Without a current sensor the current is
///   computed from the motor's law.
namespace sim::residuals {

/// Windows of the residuals; chosen.
struct Windows {
  double half_width_s = 0.03;
  double stride_s = 0.02;             ///< from one window to the next
  double speed_half_width_s = 0.006;  ///< of the window under which speeds are computed
};

/// Returns the rows at the middle of an episode's windows; empty: the episode is too short.
std::vector<std::size_t> windows_of(const Episode& episode, const Windows& windows);

/// Evaluates recordings with a robot and its effects.
class Stages {
 public:
  /// Throws the exceptions of effects::equip.
  explicit Stages(const erp::Robot& robot, const Windows& windows = {});
  /// Episodes with the same columns have the same list of residuals.
  Explanation explain(const Episode& episode);
  /// Recomputes only the parts in `reach`. The other parts are copied from `base`, an explanation
  /// of the same episode by a robot that differs in one effect.
  Explanation explain(const Episode& episode, const Explanation& base, const Reach& reach);
  /// Computes all parts. The search for unmeasured joints starts at `guess` and uses its linearized
  /// tendon paths, if it has any.
  Explanation explain(const Episode& episode, std::shared_ptr<const JointTrace> guess);
  std::vector<Residual> residuals(const Episode& episode) { return explain(episode).residuals; }

  /// Returns the parts that an effect changes.
  Reach reach(const effects::Placed& placed) const;
  const Windows& windows() const { return windows_; }

 private:
  struct Touched {
    bool joints, bones;
    std::vector<std::size_t> paths, chains;
  };
  std::vector<PathTrace> paths(const Episode& episode, const JointTrace& joints,
                               std::span<const std::size_t> actuators);
  std::vector<PathTrace> paths_nearby(const JointTrace& joints,
                                      std::span<const std::size_t> actuators) const;
  Explanation recompute(const Episode& episode, Explanation explanation, const Touched& touched);
  JointTrace joint_trace(const Episode& episode, std::span<const std::size_t> rows,
                         const JointTrace* guess);
  /// Unmeasured joints whose angles may be estimated from tendons. Free joints are excluded:
  /// tendons do not determine them.
  std::vector<std::size_t> missing_joints(const JointTrace& trace) const;
  /// Tendons with measured shaft and tension that cross only measured joints and those of
  /// `missing`.
  std::vector<std::size_t> informative_tendons(const Episode& episode, const JointTrace& trace,
                                               std::span<const std::size_t> missing) const;
  /// Estimates the missing joints, if enough tendons determine them.
  void find_pose(const Episode& episode, JointTrace& trace, const JointTrace* guess);
  /// Estimates the angles of joints whose sensor has play from the measured tensions, at rows at
  /// which the sensor may rest.
  void find_crossings(const Episode& episode, JointTrace& trace, std::span<const LooseJoint> loose);
  /// The chains of the given actuators, in their order.
  std::vector<ChainTrace> chains_of(const Episode& episode, std::span<const std::size_t> lines,
                                    const JointTrace& joints);
  std::shared_ptr<const PathsNearby> nearby(const Episode& episode, const JointTrace& trace,
                                            std::span<const std::size_t> missing);
  /// `other`: as in `trace` (chain_trace.hpp).
  ChainTrace chain(const Episode& episode, std::size_t actuator, const PathTrace& path,
                   const ChainTrace* other = nullptr) const;
  /// The unmeasured joint of a flexible link: its angle, speed and acceleration at every row.
  struct Flexion {
    std::size_t joint;
    std::vector<std::array<double, 3>> states;
  };
  std::vector<Flexion> flexions(const Episode& episode, JointTrace& trace);
  Eigen::MatrixXd bones(const Episode& episode, const JointTrace& joints,
                        std::span<const std::size_t> rows);
  void add_joints(const Episode& episode, Explanation& explanation) const;
  bool add_joint_torque(std::size_t joint, const JointReading& reading,
                        Eigen::Ref<Eigen::VectorXd> torque) const;
  /// Motion of a revolute joint in a window.
  enum class Mobility { moves, rests, mixed };
  Mobility mobility(const JointTrace& joints, std::size_t joint, const Bump& bump,
                    std::size_t row) const;
  /// The torque that neither friction at rest nor a stop can explain, and the band that they may
  /// balance.
  std::pair<double, double> remaining_torque(const JointTrace& joints, std::size_t joint,
                                             const Bump& bump, std::size_t row,
                                             double torque_Nm) const;

  effects::Equipped equipped_;
  Windows windows_;
  Skeletal bones_;
  std::vector<std::string> recorded_joints_;
};

}  // namespace sim::residuals

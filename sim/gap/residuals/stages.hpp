#pragma once
#include <array>
#include <functional>
#include <string>
#include <vector>

#include "sim/gap/residuals/explanation.hpp"
#include "sim/gap/residuals/loose_joint.hpp"
#include "sim/model/effects/library.hpp"

/// Where model and recording part: the chain cut at every measured signal, each stage driven by
/// what was measured at its ends, so that an error upstream cannot pose as one downstream.
///
///   motor     V − R i − L di/dt − K_E N ω                                   (V)
///   gearbox   J_M N² ω̇ − N (K_T ī − µ_M N ω − s τ_CM) + X/e                 (Nm),
///             X = µ_G ω + s τ_CG + r F, e as in motor.hpp
///   tendon    F − [f(Δx) + D dΔx/dt],  Δx from q and θ                       (N)
///   joint     H q̈ + C + τ_G + friction + Σ F ∂L/∂q                          (Nm), one a coordinate
///
/// each as a mean under a window (bump.hpp). The current at a row is that at the end of a period
/// over which the voltage was held (held_voltage.hpp). Where a joint rests or turns back, friction
/// is anything within a band, and a stop within reach may push: what remains beyond counts, and
/// the noise that the band hides with it; so where a shaft turns back. Windows in which a shaft or a
/// ball joint rests, or that joint is at its stop, are left out. Spindle and
/// routing act within the tendon's stage, bodies within the joint's. Without a tension sensor the
/// spring's law takes its place and the tendon's stage is part of those that use it; without a
/// current the motor's law does.
namespace sim::residuals {

struct Windows {
  double half_width_s = 0.03;
  double stride_s = 0.02;
  double speed_half_width_s = 0.006;
};

/// The rows in the middle of an episode's windows; none: it is too short to judge anything by.
std::vector<std::size_t> windows_of(const Episode& episode, const Windows& windows);

/// A robot with its effects, ready to be held against recordings.
class Stages {
 public:
  /// Throws as effects::equip.
  explicit Stages(const erp::Robot& robot, const Windows& windows = {});
  /// The residuals are the same list for every episode that has the same columns.
  Explanation explain(const Episode& episode);
  /// The same, with what `reach` leaves untouched taken from `base`: an explanation of the same
  /// episode by a robot that differs in one effect.
  Explanation explain(const Episode& episode, const Explanation& base, const Reach& reach);
  /// The same from the start, but that joints which were not measured are looked for near `guess`,
  /// with the tendons' paths taken as linear there where it has them so.
  Explanation explain(const Episode& episode, std::shared_ptr<const JointTrace> guess);
  std::vector<Residual> residuals(const Episode& episode) { return explain(episode).residuals; }

  /// What such an effect reaches.
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
  Explanation renew(const Episode& episode, Explanation explanation, const Touched& touched);
  JointTrace joint_trace(const Episode& episode, std::span<const std::size_t> rows,
                         const JointTrace* guess);
  /// Joints that the recording leaves out and tendons may tell: no free ones, of which they say too
  /// little.
  std::vector<std::size_t> missing_joints(const JointTrace& trace) const;
  /// Tendons that say shaft and tension, and cross no joint but those and measured ones.
  std::vector<std::size_t> informative_tendons(const Episode& episode, const JointTrace& trace,
                                               std::span<const std::size_t> missing) const;
  /// Sets them, if enough tendons say where they are.
  void find_pose(const Episode& episode, JointTrace& trace, const JointTrace* guess);
  /// Where loose sensors may rest, sets their joints to where the tendons pull as measured.
  void find_crossings(const Episode& episode, JointTrace& trace, std::span<const LooseJoint> loose);
  /// Of some actuators, in their order.
  std::vector<ChainTrace> chains_of(const Episode& episode, std::span<const std::size_t> lines,
                                    const JointTrace& joints);
  std::shared_ptr<const PathsNearby> nearby(const Episode& episode, const JointTrace& trace,
                                            std::span<const std::size_t> missing);
  /// `near`: as `trace` has it.
  ChainTrace chain(const Episode& episode, std::size_t actuator, const PathTrace& path,
                   const ChainTrace* near = nullptr) const;
  /// A joint that nobody measured, where a bone bends: at every row its angle, speed and acceleration.
  struct Bend {
    std::size_t joint;
    std::vector<std::array<double, 3>> states;
  };
  std::vector<Bend> bend(const Episode& episode, JointTrace& trace);
  Eigen::MatrixXd bones(const Episode& episode, const JointTrace& joints,
                        std::span<const std::size_t> rows);
  void add_joints(const Episode& episode, Explanation& explanation) const;
  bool pass_joint(std::size_t joint, const JointReading& reading,
                  Eigen::Ref<Eigen::VectorXd> torque) const;
  /// How a revolute joint moves over a window.
  enum class Gait { glides, rests, mixed };
  Gait gait(const JointTrace& joints, std::size_t joint, const Bump& bump, std::size_t row) const;
  std::pair<double, double> leave(const JointTrace& joints, std::size_t joint, const Bump& bump,
                                  std::size_t row, double torque_Nm) const;

  effects::Equipped equipped_;
  Windows windows_;
  Skeletal bones_;
  std::vector<std::string> recorded_joints_;
};

}  // namespace sim::residuals

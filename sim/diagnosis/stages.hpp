#pragma once
#include <functional>
#include <string>
#include <vector>

#include "sim/diagnosis/skeletal.hpp"
#include "sim/effects/library.hpp"

/// Where model and recording part: the chain cut at every measured signal, each stage driven by
/// what was measured at its ends, so that an error upstream cannot pose as one downstream.
///
///   motor     V − R i − L di/dt − K_E N ω,  where V is held di/dt = −K_E N ω̇/R  (V)
///   gearbox   J_M N² ω̇ − N (K_T ī − µ_M N ω − s τ_CM) + X/e                 (Nm),
///             X = µ_G ω + s τ_CG + r F, e as in motor.hpp
///   tendon    F − [f(Δx) + D dΔx/dt],  Δx from q and θ                       (N)
///   joint     H q̈ + C + τ_G + friction + Σ F ∂L/∂q                          (Nm), one a coordinate
///
/// each as a mean under a window (bump.hpp). The current at a row is that at the end of a period
/// over which the voltage was held. Where a shaft or joint rests, friction is anything within a
/// band: such windows are left out. Spindle and routing act within the tendon's stage, bodies
/// within the joint's. Without a tension sensor the spring's law takes its place and the tendon's
/// stage is part of those that use it; without a current the motor's law does.
namespace sim::diagnosis {

/// One stage's residual at the windows of an episode; NaN: not to be had there.
struct Residual {
  effects::Stage stage;
  std::string on;  ///< actuator or joint
  const char* unit;
  std::vector<double> value;
};

struct Windows {
  double half_width_s = 0.03;
  double stride_s = 0.02;
  double speed_half_width_s = 0.006;
};

/// A robot with its effects, ready to be held against recordings.
class Stages {
 public:
  /// Throws as effects::equip.
  explicit Stages(const erp::Robot& robot, const Windows& windows = {});
  /// The same list for every episode that has the same columns; windows by row, first to last.
  std::vector<Residual> residuals(const Episode& episode);
  /// The rows in the middle of the windows.
  std::vector<std::size_t> rows(const Episode& episode) const;

 private:
  struct View;  ///< an episode, with what lies between its signals
  std::vector<JointSignals> undone(const Episode& episode) const;
  Residual under_windows(const View& view, effects::Stage stage, const std::string& on,
                         const char* unit,
                         const std::function<double(const Bump&, std::size_t)>& at) const;
  void add_motor(const View& view, std::size_t actuator, std::vector<Residual>& all) const;
  void add_gearbox(const View& view, std::size_t actuator, std::vector<Residual>& all) const;
  void add_tendon(const View& view, std::size_t actuator, std::vector<Residual>& all) const;
  void add_joints(View& view, std::vector<Residual>& all);
  Eigen::VectorXd balance(const View& view, const Motion& motion, const Bump& bump,
                          std::size_t row);
  bool glides(const View& view, std::size_t joint, const Bump& bump, std::size_t row) const;
  bool pass_joint(std::size_t joint, const JointReading& reading,
                  Eigen::Ref<Eigen::VectorXd> torque) const;

  effects::Equipped equipped_;
  Windows windows_;
  Skeletal bones_;
  std::vector<std::string> recorded_joints_;
};

}  // namespace sim::diagnosis

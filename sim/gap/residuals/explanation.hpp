#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/gap/residuals/chain_trace.hpp"
#include "sim/gap/residuals/skeletal.hpp"
#include "sim/model/effects/effect.hpp"

/// An episode evaluated with a robot and its effects. Explanations share equal parts. After a
/// change of one effect only the affected parts are recomputed.
namespace sim::residuals {

/// One stage's residual at the windows of an episode; NaN: not available there.
struct Residual {
  effects::Stage stage;
  std::string on;  ///< actuator or joint
  const char* unit;
  std::vector<double> value;
  /// rms of the input of the stage: voltage, motor torque, tension or torque of the tendons
  double driven_by = 0;
  /// For each window, the torque that friction at rest or a stop (infinity) may balance. `value` is
  /// the part of the residual beyond this band. Empty: 0 everywhere.
  std::vector<double> band = {};
};

/// Whether a part of the residual may be hidden by friction at rest or by a stop.
inline bool banded(const Residual& residual, std::size_t window) {
  return !residual.band.empty() && residual.band[window] > 0;
}

/// Paths of tendons near a pose, linearized in the angles of the estimated hinges.
struct PathsNearby {
  std::vector<JointSignals> pose;
  std::vector<PathTrace> paths;              ///< at the pose, one for each actuator
  std::vector<std::vector<Signal>> slope_m;  ///< for each actuator, per rad of each estimated hinge
  std::vector<std::size_t> hinges;
};

/// The joints over an episode, with the effects of their sensors inverted.
struct JointTrace {
  std::vector<JointSignals> signals;
  std::vector<Signal> speed_rad_per_s;  ///< of revolute joints
  bool complete = false;                ///< every joint is measured, or estimated from the tendons
  std::vector<Motion> motions;          ///< one for each window, if complete
  bool estimated = false;               ///< some angles are estimated from the tendons
  bool depends_on_tendons = false;      ///< estimated or loose: the angles depend on the tendons
  bool depends_on_bodies = false;       ///< flexible links: the angles depend on the masses
  /// At the estimated angles; null if one of the estimated joints is a ball joint.
  std::shared_ptr<const PathsNearby> nearby;
};

struct Explanation {
  std::vector<std::size_t> rows;  ///< at the middle of each window
  std::shared_ptr<const JointTrace> joints;
  std::vector<std::shared_ptr<const PathTrace>> paths;            ///< one for each actuator
  std::vector<std::shared_ptr<const Eigen::MatrixXd>> gradients;  ///< ∂L/∂q, coordinates × windows
  std::vector<std::shared_ptr<const ChainTrace>> chains;
  std::vector<std::shared_ptr<const std::vector<Residual>>> chain_residuals;
  /// H q̈ + C + τ_G + friction, coordinates × windows.
  std::shared_ptr<const Eigen::MatrixXd> bones;
  std::vector<Residual> residuals;
};

/// The parts of an explanation that an effect changes, directly or indirectly.
struct Reach {
  bool joints = false;                    ///< joint angles, and thus all parts
  bool bones = false;                     ///< bodies and joint friction
  bool line = false;                      ///< the law of a tendon: its length and tension at a pose
  std::optional<std::size_t> chain = {};  ///< index of the actuator
  std::optional<std::size_t> path = {};   ///< index of the actuator whose path changes
};

}  // namespace sim::residuals

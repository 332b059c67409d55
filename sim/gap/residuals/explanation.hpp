#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/model/effects/effect.hpp"
#include "sim/gap/residuals/chain_trace.hpp"
#include "sim/gap/residuals/skeletal.hpp"

/// An episode as a robot with effects explains it. Its pieces are shared with explanations that
/// differ elsewhere, so that to try one effect costs what that effect reaches.
namespace sim::residuals {

/// One stage's residual at the windows of an episode; NaN: not to be had there.
struct Residual {
  effects::Stage stage;
  std::string on;  ///< actuator or joint
  const char* unit;
  std::vector<double> value;
  /// rms of what drives the stage: V, motor torque, tension, pull of tendons
  double driven_by = 0;
  /// By window, how much something may take, friction at rest or a stop (infinity): the value is what
  /// lies beyond that, and noise less than that cannot be seen. Empty: 0 everywhere.
  std::vector<double> band = {};
};

inline bool banded(const Residual& residual, std::size_t window) {
  return !residual.band.empty() && residual.band[window] > 0;
}

/// Paths of tendons near a pose, as if their lengths were linear in it.
struct PathsNearby {
  std::vector<JointSignals> pose;
  std::vector<PathTrace> paths;              ///< there, one an actuator
  std::vector<std::vector<Signal>> slope_m;  ///< of each, per rad of each hinge that was found
  std::vector<std::size_t> hinges;
};

/// The joints over an episode, their sensors' effects undone.
struct JointTrace {
  std::vector<JointSignals> signals;
  std::vector<Signal> speed_rad_per_s;  ///< of revolute joints
  bool complete = false;                ///< every joint was measured, or found by the tendons
  std::vector<Motion> motions;          ///< one a window, if complete
  bool estimated = false;               ///< some were told by the tendons (pose_from_tendons.hpp)
  bool by_lines = false;  ///< estimated, or loose: they move with what is known of a line
  bool by_bones = false;  ///< some bend under the bones: they move with what those weigh
  std::shared_ptr<const PathsNearby> nearby;  ///< of those; none where a ball joint is among them
};

struct Explanation {
  std::vector<std::size_t> rows;  ///< in the middle of the windows
  std::shared_ptr<const JointTrace> joints;
  std::vector<std::shared_ptr<const PathTrace>> paths;            ///< one an actuator
  std::vector<std::shared_ptr<const Eigen::MatrixXd>> gradients;  ///< ∂L/∂q, coordinates × windows
  std::vector<std::shared_ptr<const ChainTrace>> chains;
  std::vector<std::shared_ptr<const std::vector<Residual>>> of_chain;
  /// H q̈ + C + τ_G + friction, coordinates × windows.
  std::shared_ptr<const Eigen::MatrixXd> bones;
  std::vector<Residual> residuals;
};

/// What an effect changes, itself and what follows from it.
struct Reach {
  bool joints = false;                    ///< angles: and so everything
  bool bones = false;                     ///< bodies and joint friction
  bool line = false;                      ///< what a line's length and pull say of the pose
  std::optional<std::size_t> chain = {};  ///< this actuator's
  std::optional<std::size_t> path = {};   ///< and its way over the bones
};

}  // namespace sim::residuals

#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/gap/residuals/bump.hpp"
#include "sim/gap/residuals/episode.hpp"
#include "sim/model/actuator/muscle_jacobian.hpp"

/// The skeleton of a robot at the joint angles of a recording: the paths of the tendons at every
/// row, and the inverse dynamics at a window.
namespace sim::residuals {

/// The path of a tendon at every row; for the transmission of a drive, −q of its load. Empty if the
/// tendon crosses a joint that was not measured.
struct PathTrace {
  Signal length_m, wrap_rad;
  /// Rate and mean of `length_m` under windows, set by `smooth`. Effects with state use the mean
  /// because noise would reduce a hysteresis.
  Signal rate_m_per_s = {}, mean_m = {};

  void smooth(double period_s, double speed_half_width_s);
};

/// Means of angles, speeds and accelerations under a window. For spherical joints, ω and its rate
/// in the child's frame.
struct Motion {
  std::vector<JointReading> joints;
  Eigen::VectorXd acceleration;
  bool valid = true;  ///< false: a sample is missing
};

/// Whether a joint was measured; a fixed joint counts as measured.
bool was_measured(const JointSignals& joint, erp::JointType type);

class Skeletal {
 public:
  explicit Skeletal(const erp::Robot& robot);

  /// The paths of the given actuators, in their order.
  std::vector<PathTrace> paths(std::span<const JointSignals> joints, std::size_t rows,
                               std::span<const std::size_t> actuators);
  /// Whether all joints were measured.
  bool measured(std::span<const JointSignals> joints) const;
  Motion motion(std::span<const JointSignals> joints, const Bump& bump, std::size_t row) const;
  /// Inverse dynamics of the motion, H q̈ + C + τ_G, by coordinate.
  Eigen::VectorXd inverse(const Motion& motion);
  /// ∂L/∂q of the given actuators, each coordinates × motions; NaN where a sample is missing.
  std::vector<Eigen::MatrixXd> gradients(std::span<const Motion> motions,
                                         std::span<const std::size_t> actuators);

  const std::vector<erp::Joint>& joint_list() const { return tree_.joints; }
  /// The joints on which an actuator's path depends.
  std::vector<std::size_t> crossed_by(std::size_t actuator) const;
  int first_of(int joint) const { return model_.first_of(joint); }
  int coordinates() const { return model_.coordinates(); }
  /// The length of a tendon's path at the initial pose; 0 for a drive.
  double initial_length_m(std::size_t actuator) const {
    return (tendons_[actuator] ? tendons_[actuator]->initial_length_m : 0);
  }

 private:
  struct Tendon {
    Routing routing;
    Levers levers;
    PathShape shape;
    double initial_length_m;
    std::vector<int> crossed;  ///< joints
  };
  JointReading reading(const JointSignals& joint, std::size_t j, std::size_t row) const;
  /// The angle of the hinge if a tendon crosses only one hinge; its length is then interpolated in
  /// a table. Null: the tendon crosses other joints, or the range of the angle is too large for a
  /// table to save time.
  const Signal* only_angle(std::size_t actuator, std::span<const JointSignals> joints) const;
  PathTrace path_by_table(std::size_t actuator, const Signal& angle_rad);

  RobotTree tree_;
  SkeletonModel model_;
  std::vector<std::optional<Tendon>> tendons_;  ///< empty for a drive
  std::vector<int> loads_;  ///< for drives, the joint of the load, L = −q; −1: no such joint
  Eigen::VectorXd gradient_, torque_;
};

}  // namespace sim::residuals

#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/model/actuator/muscle_jacobian.hpp"
#include "sim/gap/residuals/bump.hpp"
#include "sim/gap/residuals/episode.hpp"

/// The bones of a robot under a recording's joint angles: the tendons' paths at every row, and the
/// balance of torques around one.
namespace sim::residuals {

/// A tendon's path over the rows, of a drive's transmission −q of its load; empty where a joint
/// that it crosses was not measured.
struct PathTrace {
  Signal length_m, wrap_rad;
  /// Of `length_m` under windows: by `smooth`. Effects that remember take the calm one, for noise would wear a
  /// hysteresis down.
  Signal rate_m_per_s = {}, calm_m = {};

  void smooth(double period_s, double speed_half_width_s);
};

/// Angles, speeds and accelerations under a window; of spherical joints ω and its rate in the
/// child's frame.
struct Motion {
  std::vector<JointReading> joints;
  Eigen::VectorXd acceleration;
  bool taken = true;  ///< false: a sample was not taken
};

/// A joint that cannot move counts as measured.
bool was_measured(const JointSignals& joint, erp::JointType type);

class Skeletal {
 public:
  explicit Skeletal(const erp::Robot& robot);

  /// Of some actuators, in their order.
  std::vector<PathTrace> paths(std::span<const JointSignals> joints, std::size_t rows,
                               std::span<const std::size_t> actuators);
  /// All joints were measured.
  bool measured(std::span<const JointSignals> joints) const;
  Motion motion(std::span<const JointSignals> joints, const Bump& bump, std::size_t row) const;
  /// H q̈ + C + τ_G of that motion, by coordinate.
  Eigen::VectorXd inverse(const Motion& motion);
  /// ∂L/∂q of some tendons, each coordinates × motions; NaN where a sample was not taken.
  std::vector<Eigen::MatrixXd> gradients(std::span<const Motion> motions,
                                         std::span<const std::size_t> actuators);

  const std::vector<erp::Joint>& joint_list() const { return tree_.joints; }
  /// The joints that an actuator's path depends on.
  std::vector<std::size_t> crossed_by(std::size_t actuator) const;
  int first_of(int joint) const { return model_.first_of(joint); }
  int coordinates() const { return model_.coordinates(); }
  /// The length at the initial pose.
  double start_m(std::size_t actuator) const {
    return (tendons_[actuator] ? tendons_[actuator]->start_m : 0);
  }

 private:
  struct Tendon {
    Routing routing;
    Levers levers;
    PathShape shape;
    double start_m;
    std::vector<int> crossed;  ///< joints
  };
  JointReading reading(const JointSignals& joint, std::size_t j, std::size_t row) const;
  /// Of a tendon over one hinge alone, whose length is then read from a table of its angle: that
  /// angle; null: it crosses more, or the angle goes too far for a table to pay.
  const Signal* only_angle(std::size_t actuator, std::span<const JointSignals> joints) const;
  PathTrace path_by_table(std::size_t actuator, const Signal& angle_rad);

  RobotTree tree_;
  SkeletonModel model_;
  std::vector<std::optional<Tendon>> tendons_;  ///< none: a drive
  std::vector<int> loads_;  ///< of drives, the joint that they turn, L = −q; −1: none of its own
  Eigen::VectorXd row_, torque_;
};

}  // namespace sim::residuals

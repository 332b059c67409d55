#pragma once
#include <vector>

#include "sim/model/actuator/muscle_jacobian.hpp"

/// A robot's bones and tendons in one posture, without a physics engine. The internal model of
/// controllers and of statics.
///
///   l(q)             lengths of the tendons' paths, m
///   L(q) = ∂l/∂q     their gradient (paper, eq. 7); actuators × coordinates
///   H, C, τ_G        see `skeleton()` (eq. 6)
///
/// Turns around pulleys are counted from posture to posture, beginning with the starting posture.
namespace sim {

class Musculoskeletal {
 public:
  /// Throws std::invalid_argument like RobotTree, and with the actuator's name like Routing or if a
  /// path point lies inside a pulley in the starting posture.
  explicit Musculoskeletal(const erp::Robot& robot);

  /// Sets the posture; `joints`: one per joint of `tree()`. No heap.
  void place(std::span<const JointReading> joints);

  const Eigen::VectorXd& length_m() const { return length_m_; }
  const Eigen::MatrixXd& jacobian() const { return jacobian_; }
  SkeletonModel& skeleton() { return skeleton_; }
  const SkeletonModel& skeleton() const { return skeleton_; }
  const RobotTree& tree() const { return tree_; }
  int coordinates() const { return skeleton_.coordinates(); }
  const std::vector<PathShape>& shapes() const { return shapes_; }

 private:
  RobotTree tree_;
  SkeletonModel skeleton_;
  std::vector<Routing> routings_;
  std::vector<Levers> levers_;
  std::vector<PathShape> shapes_;
  Eigen::VectorXd length_m_, row_;
  Eigen::MatrixXd jacobian_;
};

}  // namespace sim

#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sim/model/skeleton/joint_reading.hpp"
#include "sim/model/skeleton/pose.hpp"
#include "sim/model/skeleton/robot_tree.hpp"

/// The robot's bodies and joints in Bullet: one btMultiBody per tree, double precision. Bullet
/// stores the joint positions and integrates them. Their velocities come from step_solver.hpp,
/// because Bullet's own step is explicit in all forces: it is unstable with stiff tendons and adds
/// energy to ball joints.
///
/// v: the joints' velocities in the order of SkeletonModel.
namespace sim {

class BulletSkeleton {
 public:
  /// `locked_joints`: joints fixed at their initial angle. Throws std::invalid_argument for an
  /// unknown one.
  BulletSkeleton(const RobotTree& tree, const Vec3& gravity_m_per_s2,
                 std::span<const std::string> locked_joints);
  ~BulletSkeleton();

  std::span<const JointReading> joints() const;
  /// Sets position and velocity of the joints, one reading each. Locked joints do not change.
  void place(std::span<const JointReading> joints);
  /// Moves all joints with velocities v for a time step.
  void move(const Eigen::VectorXd& v, double dt_s);

  /// Result of Bullet's own dynamics: the inverse of the joint-space inertia and the accelerations
  /// under gravity, without friction and limits; and the positions of the bodies. For robots
  /// without free bodies, with the principal axes of each body along its frame.
  struct Response {
    Eigen::MatrixXd inverse_inertia;
    Eigen::VectorXd acceleration;
    std::vector<Vec3> com_m;  ///< of each body; a root's is 0
  };
  Response respond();

 private:
  struct Bullet;
  std::unique_ptr<Bullet> bullet_;
};

}  // namespace sim

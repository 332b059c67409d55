#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sim/model/skeleton/joint_reading.hpp"
#include "sim/model/skeleton/pose.hpp"
#include "sim/model/skeleton/robot_tree.hpp"

/// The robot's bones and joints in Bullet: one btMultiBody a tree, double precision. Bullet holds
/// where the joints are and moves them; which velocities they get is decided outside
/// (step_solver.hpp), because Bullet's own step, explicit in all forces, would explode with stiff
/// tendons and feeds energy into ball joints.
///
/// v: the joints' velocities in the order of SkeletonModel.
namespace sim {

class BulletSkeleton {
 public:
  /// `lock`: joints held at their initial angle. Throws std::invalid_argument for an unknown one.
  BulletSkeleton(const RobotTree& tree, const Vec3& gravity_m_per_s2,
                 std::span<const std::string> lock);
  ~BulletSkeleton();

  std::span<const JointReading> joints() const;
  /// Puts the joints somewhere, one reading each. A locked joint stays.
  void place(std::span<const JointReading> joints);
  /// Moves all joints with velocities v for a time step.
  void move(const Eigen::VectorXd& v, double dt_s);

  /// What Bullet's own dynamics answer here: the inverse of the joints' inertia and their
  /// accelerations under gravity, without friction and limits; and where the bodies are. For robots
  /// without free bodies, whose bodies have their principal axes along their frames.
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

#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sim/skeleton/joint_reading.hpp"
#include "sim/skeleton/pose.hpp"
#include "sim/skeleton/robot_tree.hpp"

/// The robot's bones and joints in Bullet: one btMultiBody a tree, double precision.
///
/// Bullet gives the articulated-body dynamics and the semi-implicit step. Ours, between its forces
/// and its motion, are
///
///   v⁺ = v + dt a(q, (v + v¹)/2),  v¹ = v + dt a(q, v)     velocity-dependent forces at mid-step
///   joint friction and limits                             joint_rows.hpp
///
/// Bullet's step alone (v⁺ = v¹) feeds energy into ball joints: 7 J in 10 s into the free arm at
/// 1 ms, against 0.07 J with the correction, for one more pass of the articulated-body algorithm.
/// Bullet's own damping and sleeping are off.
namespace sim {

class BulletSkeleton {
 public:
  /// `lock`: joints held at their initial angle. Throws std::invalid_argument for an unknown one.
  BulletSkeleton(const RobotTree& tree, const Vec3& gravity_m_per_s2,
                 std::span<const std::string> lock);
  ~BulletSkeleton();

  std::span<const BodyPose> poses() const;
  std::span<const BodyTwist> twists() const;
  std::span<const JointReading> joints() const;
  /// Puts a joint somewhere; readings follow. Ignored for a locked joint.
  void set_joint(int joint, const JointReading& reading);

  /// A force at a world point of a body, until the next step.
  void push(int body, const Vec3& at_m, const Vec3& force_N);
  void step(double dt_s);
  /// What all joint coordinates answer, in the order of SkeletonModel: the inverse of their inertia
  /// and their accelerations under gravity, without friction and limits. Forgets what was pushed.
  struct Response {
    Eigen::MatrixXd inverse_inertia;
    Eigen::VectorXd acceleration;
  };
  Response respond();
  /// Kinetic and potential energy.
  double energy_J() const;

 private:
  struct Bullet;
  std::unique_ptr<Bullet> bullet_;
};

}  // namespace sim

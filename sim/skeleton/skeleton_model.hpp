#pragma once
#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "sim/skeleton/joint_reading.hpp"
#include "sim/skeleton/robot_tree.hpp"
#include "sim/skeleton/spatial.hpp"

/// A robot's bones in joint coordinates, without a physics engine (paper, eq. 6):
///
///   τ = H(q) a + C(q, v) + τ_G(q)
///
/// v: one coordinate a revolute joint, three a spherical one (angular velocity of the child, in the
/// child's frame), none a fixed or locked one; in the order of RobotTree's bodies. a = dv/dt.
///
///   inverse   recursive Newton–Euler      f_i = I a_i + v_i ×* I v_i,  τ_i = S_iᵀ f_i
///   H         composite rigid bodies      H_ij = S_iᵀ F_j,  F_j = I^c_j S_j carried to i
///   torques   Jᵀ F: of forces at points of bodies, such as the pulls of a tendon
///
/// Source: Featherstone 2008, tables 5.1 and 6.2. No friction, no limits; no heap after
/// construction, but in `forward`.
namespace sim {

class SkeletonModel {
 public:
  /// `lock`: joints held at their initial angle. Throws std::invalid_argument for an unknown one.
  SkeletonModel(const RobotTree& tree, const Vec3& gravity_m_per_s2,
                std::span<const std::string> lock = {});

  int coordinates() const { return coordinates_; }
  /// Where a joint's coordinates begin in v, by its index in RobotTree::joints; −1: it has none.
  int first_of(int joint) const { return first_of_[static_cast<std::size_t>(joint)]; }

  /// Moves the bones there; all that follows is of this posture and these velocities.
  void place(std::span<const JointReading> joints);
  std::span<const BodyPose> poses() const { return poses_; }
  std::span<const BodyTwist> twists() const { return twists_; }

  /// The joints' velocities as one v.
  void gather_velocity(std::span<const JointReading> joints, Eigen::VectorXd& v) const;
  /// The torques that accelerate by `a`.
  void inverse(const Eigen::VectorXd& a, Eigen::VectorXd& tau) { newton_euler(&a, true, tau); }
  /// C + τ_G.
  void bias(Eigen::VectorXd& tau) { newton_euler(nullptr, true, tau); }
  /// τ_G: what holds the bones still against gravity.
  void gravity_torques(Eigen::VectorXd& tau) { newton_euler(nullptr, false, tau); }
  /// H, symmetric, coordinates × coordinates.
  void inertia(Eigen::MatrixXd& h);
  /// The accelerations that torques cause.
  Eigen::VectorXd forward(const Eigen::VectorXd& tau);
  /// Adds the torques of a force at a point of a body, both in the world, to `tau`.
  void add_torques(int body, const Vec3& at_m, const Vec3& force_N, Eigen::VectorXd& tau) const;
  /// Kinetic and potential.
  double energy_J() const;

 private:
  using Subspace = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 3>;
  struct Link {
    int body, joint, parent;  ///< parent: a link, −1: the world
    int first = 0, dofs = 0;
    Placement placement;
    Subspace subspace;  ///< S
    Mat6 inertia, composite;
    Vec6 velocity = Vec6::Zero(), acceleration = Vec6::Zero(), force = Vec6::Zero();
  };
  void add_link(int body, bool locked);
  void turn(Link& link, const JointReading& joint) const;
  void newton_euler(const Eigen::VectorXd* a, bool moving, Eigen::VectorXd& tau);

  RobotTree tree_;
  Vec3 gravity_;
  int coordinates_ = 0;
  std::vector<Link> links_;
  std::vector<int> link_of_, first_of_;  ///< by body, by joint
  std::vector<BodyPose> poses_;
  std::vector<BodyTwist> twists_;
};

}  // namespace sim

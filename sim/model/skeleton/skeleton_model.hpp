#pragma once
#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "sim/model/skeleton/joint_reading.hpp"
#include "sim/model/skeleton/robot_tree.hpp"
#include "sim/model/skeleton/spatial.hpp"

/// A robot's bones in joint coordinates, without a physics engine (paper, eq. 6):
///
///   τ = H(q) a + C(q, v) + τ_G(q)
///
/// v has one coordinate per revolute joint, three per spherical joint (angular velocity of the
/// child, in the child's frame), six per free joint (the same, then the velocity of the centre of
/// mass in the root's frame), and none per fixed or locked joint, in the order of RobotTree's
/// bodies. a = dv/dt. Column S_d is the spatial velocity for a unit velocity of coordinate d, in
/// the world frame.
///
///   inverse   recursive Newton–Euler      f_i = I a_i + v_i ×* I v_i,  τ_d = S_dᵀ Σ f  (outwards)
///   H         composite rigid bodies      H_de = S_dᵀ I^c_e S_e,  d towards the root from e
///   torques   S_dᵀ (at × F, F), for forces at points of bodies, such as the pulls of a tendon
///
/// Source: Featherstone 2008, chapters 5 and 6. Ignores friction and joint limits. No heap after
/// construction, except in `forward`.
namespace sim {

class SkeletonModel {
 public:
  /// `locked_joints`: joints fixed at their initial angle. Throws std::invalid_argument for an
  /// unknown joint.
  SkeletonModel(const RobotTree& tree, const Vec3& gravity_m_per_s2,
                std::span<const std::string> locked_joints = {});

  int coordinates() const { return static_cast<int>(axes_.cols()); }
  /// Index in v of a joint's first coordinate; `joint`: index in RobotTree::joints. −1: no
  /// coordinate.
  int first_of(int joint) const { return first_of_[static_cast<std::size_t>(joint)]; }
  /// The coordinates that move a body, from the nearest joint to the root.
  std::span<const int> movers(int body) const { return movers_[static_cast<std::size_t>(body)]; }
  /// S_d.
  auto axis(int coordinate) const { return axes_.col(coordinate); }

  /// Changes the mass of a body; takes effect with the next `place`.
  void set_mass(int body, const erp::Mass& mass);
  /// Sets posture and velocities, on which all results below depend.
  void place(std::span<const JointReading> joints);
  std::span<const BodyPose> poses() const { return poses_; }
  std::span<const BodyTwist> twists() const { return twists_; }
  /// v of the last `place`.
  const Eigen::VectorXd& velocity() const { return velocity_; }

  /// The torques for the accelerations `a` (inverse dynamics).
  void inverse(const Eigen::VectorXd& a, Eigen::VectorXd& tau) { newton_euler(velocity_, &a, tau); }
  /// C + τ_G, for the velocities of `place` or for other velocities in the same posture.
  void bias(Eigen::VectorXd& tau) { newton_euler(velocity_, nullptr, tau); }
  void bias(const Eigen::VectorXd& v, Eigen::VectorXd& tau) { newton_euler(v, nullptr, tau); }
  /// τ_G: the torques that compensate gravity at rest.
  void gravity_torques(Eigen::VectorXd& tau) { newton_euler(zero_velocity_, nullptr, tau); }
  /// H, symmetric, coordinates × coordinates.
  void inertia(Eigen::MatrixXd& h);
  /// The accelerations for given torques (forward dynamics).
  Eigen::VectorXd forward(const Eigen::VectorXd& tau);
  /// Kinetic plus potential energy.
  double energy_J() const;

 private:
  struct Link {
    int body, joint, parent;  ///< parent: index of a link; −1: the world
    int first = 0, dofs = 0;
    Vec3 axis = Vec3::UnitY();                               ///< of a revolute joint
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< child to parent
    Vec3 origin_m = Vec3::Zero();                            ///< in the parent's frame
    Eigen::Matrix3d central_kg_m2;                           ///< inertia about the centre of mass
    SpatialInertia inertia, composite;
    Vec6 velocity = Vec6::Zero();  ///< of the last `place`
    Vec6 motion = Vec6::Zero(), acceleration = Vec6::Zero(), force = Vec6::Zero();
  };
  void add_link(int body, bool locked);
  void set_rotation(Link& link, const JointReading& joint) const;
  void place(Link& link);
  Vec6 joint_velocity(const Link& link, const Eigen::VectorXd& v) const;
  Vec3 sliding_velocity(const Link& link, const Eigen::VectorXd& v) const;
  void newton_euler(const Eigen::VectorXd& v, const Eigen::VectorXd* a, Eigen::VectorXd& tau);

  RobotTree tree_;
  Vec3 gravity_;
  std::vector<Link> links_;
  Eigen::Matrix<double, 6, Eigen::Dynamic> axes_;
  std::vector<int> link_of_, first_of_;  ///< by body, by joint
  std::vector<std::vector<int>> movers_;
  std::vector<BodyPose> poses_;
  std::vector<BodyTwist> twists_;
  Eigen::VectorXd velocity_, zero_velocity_;
};

}  // namespace sim

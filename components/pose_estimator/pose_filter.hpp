#pragma once
#include <Eigen/Core>
#include <vector>

#include "sim/model/actuator/musculoskeletal.hpp"
#include "sim/model/skeleton/joint_path.hpp"

/// Joint angles and velocities from the path lengths of the tendons: an error-state Kalman filter.
///
///   state    q ⊕ δ, v + ε,        P = E[(δ, ε)(δ, ε)ᵀ]         δ of ball joints in the child's frame
///   predict  q ← q ⊕ v dt,  v ← v + a dt,   a = H⁻¹ (−Lᵀ F − C − τ_G − τ_f)     F as measured
///            P ← A P Aᵀ + σ_a² G Gᵀ,  A = [1 dt; 0 1],  G = [dt²/2; dt]
///   update   l̂_a − l_a(q) = L_a δ + noise σ_l:   one tendon after the other, each with its own gate
///
///   update   ω̂ − R_bᵀ ω_b = R_bᵀ (S ε + (ω_p × S) δ) + noise,   f̂ + R_bᵀ g = −R_bᵀ (g × S) δ + noise
///            an inertial unit on body b: angular velocity ω̂ and specific force f̂;
///            the acceleration of the body counts as noise;
///            S: joint axes that move b, ω_p: angular velocity of the parent body of each axis
///
/// Ball joints need no angles in this form. A measurement whose innovation exceeds `gate` standard
/// deviations is rejected, for example if a sensor has failed or a line has slipped. Source: Solà
/// 2017, quaternion kinematics for the error-state Kalman filter; sequential updates: Maybeck 1979.
/// No heap after construction.
namespace pose {

/// σ_a, σ of the initial state, gate; described in PoseEstimator::Params.
struct FilterOptions {
  double acceleration_rad_per_s2 = 20;
  double start_rad = 0.1, start_rad_per_s = 0.1;
  double gate = 5;
};

class PoseFilter {
 public:
  using Vector = Eigen::VectorXd;
  using Matrix = Eigen::MatrixXd;

  /// Starts in the robot's starting pose, at rest.
  PoseFilter(const erp::Robot& robot, const FilterOptions& options);

  /// Predicts one period ahead, under tensions by actuator, in N; at most 64.
  void predict(double dt_s, const Vector& tension_N);
  /// Updates with a path length, in m, and its σ. False: rejected.
  bool update_length(int actuator, double length_m, double sigma_m);
  /// Updates with a joint's position, from motion capture or a joint sensor, and the σ of each
  /// axis. False: rejected.
  bool update_joint(int joint, const std::array<double, 4>& position, double sigma_rad);
  /// Updates with a body's angular velocity in its own axes, in rad/s, and the σ of each axis.
  /// False: rejected.
  bool update_angular_velocity(int body, const sim::Vec3& measured_rad_per_s,
                               double sigma_rad_per_s);
  /// Updates with the specific force on a body in its own axes, in m/s², and the σ of each axis.
  /// The body's acceleration counts as noise. False: rejected.
  bool update_gravity(int body, const sim::Vec3& force_m_per_s2, double sigma_m_per_s2);
  /// Applies the accumulated correction to the pose, after the updates of a period.
  void apply_correction();

  /// v, by coordinate.
  const Vector& speed_rad_per_s() const { return speed_; }
  std::span<const sim::JointReading> joints() const { return joints_; }
  /// Covariance of δ and ε in the coordinates of the skeleton, 2 n × 2 n.
  const Matrix& covariance() const { return p_; }
  const sim::Musculoskeletal& model() const { return model_; }

 private:
  bool update(const Vector& h, double innovation, double sigma);
  sim::Vec3 axis_on(int body, int coordinate) const;
  sim::Vec3 parent_angular_rad_per_s(int coordinate) const;
  void accelerate(double dt_s, const Vector& tension_N);
  void move_joints(const Eigen::Ref<const Vector>& displacement);

  FilterOptions options_;
  sim::Musculoskeletal model_;
  sim::Vec3 gravity_m_per_s2_;
  std::vector<sim::JointReading> joints_;
  std::vector<double> viscous_;  ///< by coordinate
  std::vector<int> parents_;     ///< parent body of each coordinate's joint
  Vector speed_, step_, error_, gain_, row_, bias_, torque_;
  Matrix p_, inertia_;
};

}  // namespace pose

#pragma once
#include <Eigen/Core>
#include <vector>

#include "sim/model/actuator/musculoskeletal.hpp"
#include "sim/model/skeleton/joint_path.hpp"

/// Joint angles and velocities from how long the tendons' paths are: an error-state Kalman filter.
///
///   state    q ⊕ δ, v + ε,        P = E[(δ, ε)(δ, ε)ᵀ]         δ of ball joints in the child's frame
///   predict  q ← q ⊕ v dt,  v ← v + a dt,   a = H⁻¹ (−Lᵀ F − C − τ_G − τ_f)     F as measured
///            P ← A P Aᵀ + σ_a² G Gᵀ,  A = [1 dt; 0 1],  G = [dt²/2; dt]
///   see      l̂_a − l_a(q) = L_a δ + noise σ_l:   one tendon after the other, each with its own gate
///
///   see      ω̂ − R_bᵀ ω_b = R_bᵀ (S ε + (ω_p × S) δ) + noise,   f̂ + R_bᵀ g = −R_bᵀ (g × S) δ + noise
///            an inertial unit on body b, S the axes that turn it and ω_p of what each is on: how it
///            turns, and, as noise as it is accelerated, what is up
///
/// So a ball joint needs no angles, and a path length that does not fit (a dead sensor, a line that
/// has slipped) is left out: beyond `gate` standard deviations of what it should be.
/// Source: Solà 2017, quaternion kinematics for the error-state Kalman filter; sequential updates:
/// Maybeck 1979. No heap after construction.
namespace pose {

struct FilterOptions {
  double acceleration_rad_per_s2 = 20;            ///< σ_a: what the dynamics do not know; chosen
  double start_rad = 0.1, start_rad_per_s = 0.1;  ///< σ of where the robot starts; chosen
  double gate = 5;                                ///< standard deviations; chosen
};

class PoseFilter {
 public:
  using Vector = Eigen::VectorXd;
  using Matrix = Eigen::MatrixXd;

  /// Starts in the robot's starting pose, at rest.
  PoseFilter(const erp::Robot& robot, const FilterOptions& options);

  /// One period on, under tensions by actuator, N; at most 64.
  void predict(double dt_s, const Vector& tension_N);
  /// A path length, m, with its σ. False: left out.
  bool see_length(int actuator, double length_m, double sigma_m);
  /// A joint's place, as from motion capture or a sensor of it, with the σ of each axis. False: left
  /// out.
  bool see_joint(int joint, const std::array<double, 4>& position, double sigma_rad);
  /// How a body turns, rad/s, in its own axes, with the σ of each axis. False: left out.
  bool see_turning(int body, const sim::Vec3& turning_rad_per_s, double sigma_rad_per_s);
  /// The specific force on a body, m/s², in its own axes, with the σ of each; what accelerates it is
  /// taken as noise. False: left out.
  bool see_up(int body, const sim::Vec3& force_m_per_s2, double sigma_m_per_s2);
  /// After a period's sights: moves the pose there.
  void settle();

  /// v, by coordinate.
  const Vector& speed_rad_per_s() const { return speed_; }
  std::span<const sim::JointReading> joints() const { return joints_; }
  /// Of δ and ε, in the coordinates of the skeleton: 2 n × 2 n.
  const Matrix& covariance() const { return p_; }
  const sim::Musculoskeletal& model() const { return model_; }

 private:
  bool see(const Vector& h, double apart, double sigma);
  sim::Vec3 axis_on(int body, int coordinate) const;
  sim::Vec3 carried_rad_per_s(int coordinate) const;
  void accelerate(double dt_s, const Vector& tension_N);
  void turn(const Eigen::Ref<const Vector>& by);

  FilterOptions options_;
  sim::Musculoskeletal model_;
  sim::Vec3 gravity_m_per_s2_;
  std::vector<sim::JointReading> joints_;
  std::vector<double> viscous_;  ///< by coordinate
  std::vector<int> parents_;     ///< the body that each coordinate's joint is on
  Vector speed_, step_, error_, gain_, row_, bias_, torque_;
  Matrix p_, inertia_;
};

}  // namespace pose

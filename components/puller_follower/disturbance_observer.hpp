#pragma once
#include <Eigen/Core>

/// Joint accelerations that the model of the skeleton does not explain: a load, friction, a wrong
/// mass.
///
///   v̂̇ = a + d + 2 w (v − v̂),   ḋ = w² (v − v̂)          a: of the model;  a + d: estimated
///
/// A disturbance observer, critically damped at w. No heap after the first `begin`.
namespace control {

class DisturbanceObserver {
 public:
  explicit DisturbanceObserver(int coordinates)
      : speed_(Eigen::VectorXd::Zero(coordinates)), disturbance_(speed_), innovation_(speed_) {}

  /// Starts in equilibrium: d cancels the model's acceleration.
  void begin(const Eigen::VectorXd& speed_rad_per_s, const Eigen::VectorXd& model_rad_per_s2) {
    speed_ = speed_rad_per_s, disturbance_ = -model_rad_per_s2;
  }
  void update(const Eigen::VectorXd& speed_rad_per_s, const Eigen::VectorXd& model_rad_per_s2,
              double dt_s) {
    innovation_ = speed_rad_per_s - speed_;
    speed_ += dt_s * (model_rad_per_s2 + disturbance_ + 2 * w_per_s * innovation_);
    disturbance_ += dt_s * w_per_s * w_per_s * innovation_;
  }
  const Eigen::VectorXd& acceleration_rad_per_s2() const { return disturbance_; }

 private:
  static constexpr double w_per_s =
      1;  // chosen: with a larger w the estimate changes faster than the motors can follow
  Eigen::VectorXd speed_, disturbance_, innovation_;
};

}  // namespace control

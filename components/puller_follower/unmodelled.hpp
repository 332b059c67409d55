#pragma once
#include <Eigen/Core>

/// What joints accelerate by beyond what a model of their bones says: a load, friction, a wrong mass.
///
///   v̂̇ = a + d + 2 w (v − v̂),   ḋ = w² (v − v̂)          a: by the model;  a + d: as it seems
///
/// Source: a disturbance observer, critically damped at w. No heap after the first `begin`.
namespace control {

class Unmodelled {
 public:
  explicit Unmodelled(int coordinates)
      : speed_(Eigen::VectorXd::Zero(coordinates)), unmodelled_(speed_), off_(speed_) {}

  /// The joints are in balance, whatever the model says.
  void begin(const Eigen::VectorXd& speed_rad_per_s, const Eigen::VectorXd& model_rad_per_s2) {
    speed_ = speed_rad_per_s, unmodelled_ = -model_rad_per_s2;
  }
  void see(const Eigen::VectorXd& speed_rad_per_s, const Eigen::VectorXd& model_rad_per_s2,
           double dt_s) {
    off_ = speed_rad_per_s - speed_;
    speed_ += dt_s * (model_rad_per_s2 + unmodelled_ + 2 * w_per_s * off_);
    unmodelled_ += dt_s * w_per_s * w_per_s * off_;
  }
  const Eigen::VectorXd& acceleration_rad_per_s2() const { return unmodelled_; }

 private:
  static constexpr double w_per_s = 1;  // chosen: faster, and motors wind up late for a catch
  Eigen::VectorXd speed_, unmodelled_, off_;
};

}  // namespace control

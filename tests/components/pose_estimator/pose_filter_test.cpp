#include "components/pose_estimator/pose_filter.hpp"

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>
#include <random>

#include "sim/control/tension_distribution.hpp"

namespace {

using Eigen::VectorXd;

const erp::Robot& arm() {
  static const erp::Robot robot = erp::read_robot(ERP_SOURCE_DIR "/configs/arm/robot.xml");
  return robot;
}

/// An arm that moves by the filter's own equations, with the process noise that the filter assumes.
class Truth {
 public:
  explicit Truth(unsigned seed)
      : distribution_(sim::objective_terms(arm(), sim::TensionObjective::least_tension, 5),
                      model_.coordinates()),
        random_(seed) {
    for (const auto& joint : model_.tree().joints) joints_.push_back(sim::initial_reading(joint));
    speed_.setZero(model_.coordinates());
    disturb_start();
  }
  /// Moves by one period; returns the tensions during it.
  VectorXd move(double dt_s, double sigma) {
    VectorXd gravity, bias;
    Eigen::MatrixXd inertia;
    model_.skeleton().bias(bias);
    model_.skeleton().inertia(inertia);
    // A soft spring towards the start keeps the arm in range.
    VectorXd acceleration = -4 * offset_ - 2 * speed_;
    const VectorXd f = distribution_.distribute(model_.jacobian(), bias + inertia * acceleration);
    VectorXd torque = -bias - model_.jacobian().transpose() * f;
    for (std::size_t j = 0; j < joints_.size(); ++j)
      for (int d = 0; d < sim::coordinates_of(joints_[j].type); ++d) {
        const int i = model_.skeleton().first_of(int(j)) + d;
        const double viscous = model_.tree().joints[j].viscous_Nm_s_per_rad;
        torque[i] -= viscous * speed_[i], inertia(i, i) += viscous * dt_s;
      }
    speed_ += dt_s * inertia.llt().solve(torque);
    const VectorXd random_acceleration =
        VectorXd::NullaryExpr(speed_.size(), [&] { return sigma * normal_(random_); });
    move_joints(dt_s * speed_ + 0.5 * dt_s * dt_s * random_acceleration);
    speed_ += dt_s * random_acceleration;
    place();
    return f;
  }
  double length_m(int a, double sigma) { return model_.length_m()[a] + sigma * normal_(random_); }
  /// (δ, ε) of the filter.
  VectorXd error_of(const pose::PoseFilter& filter) const {
    VectorXd e(2 * speed_.size());
    for (std::size_t j = 0; j < joints_.size(); ++j) {
      const auto& estimated = filter.joints()[j];
      const auto rotation =
          sim::displacement(joints_[j].type, estimated.position, joints_[j].position);
      const int first = model_.skeleton().first_of(int(j));
      for (int d = 0; d < sim::coordinates_of(joints_[j].type); ++d)
        e[first + d] = rotation[std::size_t(d)];
    }
    e.tail(speed_.size()) = speed_ - filter.speed_rad_per_s();
    return e;
  }
  std::vector<sim::JointReading> joints_;

 private:
  void disturb_start() {
    offset_.setZero(speed_.size());
    move_joints(VectorXd::NullaryExpr(speed_.size(), [&] { return 0.05 * normal_(random_); }));
    speed_ = VectorXd::NullaryExpr(speed_.size(), [&] { return 0.1 * normal_(random_); });
    place();
  }
  void move_joints(const VectorXd& displacement) {
    offset_ += displacement;
    for (std::size_t j = 0; j < joints_.size(); ++j) {
      std::array<double, 3> rotation{};
      const int first = model_.skeleton().first_of(int(j));
      for (int d = 0; d < sim::coordinates_of(joints_[j].type); ++d)
        rotation[std::size_t(d)] = displacement[first + d];
      joints_[j].position = sim::displaced(joints_[j].type, joints_[j].position, rotation);
    }
  }
  void place() {
    for (std::size_t j = 0; j < joints_.size(); ++j)
      for (int d = 0; d < sim::coordinates_of(joints_[j].type); ++d)
        joints_[j].velocity_rad_per_s[std::size_t(d)] =
            speed_[model_.skeleton().first_of(int(j)) + d];
    model_.place(joints_);
  }

  sim::Musculoskeletal model_{arm()};
  sim::TensionDistribution distribution_;
  VectorXd speed_, offset_;
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
};

constexpr pose::FilterOptions options{
    .acceleration_rad_per_s2 = 5, .start_rad = 0.05, .start_rad_per_s = 0.1, .gate = 5};
constexpr double sigma_m = 2e-4, dt_s = 0.002;
constexpr int actuators = 11;  // of the arm

/// A tendon whose measured length is stuck at its initial value plus `offset_m`.
struct StuckSensor {
  int tendon = -1;
  double offset_m = 0;
};

/// eᵀ P⁻¹ e of one run of half a second.
double run(unsigned seed, const StuckSensor& stuck = {}, double* worst_rad = nullptr) {
  Truth truth(seed);
  pose::PoseFilter filter(arm(), options);
  const double stuck_m = truth.length_m(std::max(stuck.tendon, 0), 0) + stuck.offset_m;
  for (int k = 0; k < 250; ++k) {
    const VectorXd f = truth.move(dt_s, options.acceleration_rad_per_s2);
    filter.predict(dt_s, f);
    for (int a = 0; a < actuators; ++a)
      filter.update_length(a, a == stuck.tendon ? stuck_m : truth.length_m(a, sigma_m), sigma_m);
    filter.apply_correction();
  }
  const VectorXd e = truth.error_of(filter);
  if (worst_rad) *worst_rad = std::max(*worst_rad, e.head(4).cwiseAbs().maxCoeff());
  return e.dot(filter.covariance().llt().solve(e));
}

}  // namespace

TEST_CASE("the normalized error squared of 60 runs agrees with the filter's covariance") {
  double sum = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) sum += run(seed);
  // Chi-squared with 60 × 8 degrees of freedom, divided by 60: 8 ± 0.5; 99.9 % within the bounds
  // below
  CHECK(sum / 60 > 6.4);
  CHECK(sum / 60 < 9.8);
}

TEST_CASE("a length error of 20 mm is rejected, and a stuck sensor causes at most 2 degrees") {
  for (int tendon = 0; tendon < actuators; ++tendon) {
    double off_rad = 0, stuck_rad = 0;
    for (unsigned seed = 1; seed <= 3; ++seed) {
      run(seed, {tendon, 0.02}, &off_rad);
      run(seed, {tendon, 0}, &stuck_rad);
    }
    INFO("tendon " << tendon);
    CHECK(off_rad < 0.017);
    CHECK(stuck_rad < 0.035);
  }
}

TEST_CASE(
    "a joint measurement with the variance of the prior moves the estimate by half of the "
    "innovation") {
  pose::PoseFilter filter(arm(), options);
  CHECK(filter.update_joint(1, {0.34}, 0.05));  // σ of the prior
  filter.apply_correction();
  CHECK(filter.joints()[1].position[0] == Approx(0.32).margin(1e-9));
  CHECK_FALSE(filter.update_joint(1, {2.0}, 0.001));
}

TEST_CASE("inertial units give the bones' angular velocity and the direction of gravity") {
  sim::Musculoskeletal truth(arm());
  std::vector<sim::JointReading> now;
  for (const auto& joint : truth.tree().joints) now.push_back(sim::initial_reading(joint));
  now[0].position = sim::displaced(now[0].type, now[0].position, {0.06, -0.05, 0.04});
  now[0].velocity_rad_per_s = {0.3, -0.5, 0.2};
  now[1].position = sim::displaced(now[1].type, now[1].position, {0.08});
  now[1].velocity_rad_per_s = {-0.4};
  truth.place(now);
  pose::FilterOptions wide = options;
  wide.start_rad = 0.1, wide.start_rad_per_s = 1;
  pose::PoseFilter filter(arm(), wide);
  const auto& true_skeleton = truth.skeleton();
  const sim::Vec3 up(0, 0, 9.81);
  const auto in_body = [](const sim::BodyPose& pose, const sim::Vec3& v) -> sim::Vec3 {
    return pose.rotation.transpose() * v;
  };
  for (int k = 0; k < 30; ++k) {
    for (const int body : {1, 2}) {
      const auto b = std::size_t(body);
      filter.update_angular_velocity(
          body, in_body(true_skeleton.poses()[b], true_skeleton.twists()[b].angular_rad_per_s),
          1e-3);
      filter.update_gravity(body, in_body(true_skeleton.poses()[b], up), 1e-2);
    }
    filter.apply_correction();
  }
  for (const std::size_t b : {1U, 2U}) {
    const auto& estimated = filter.model().skeleton();
    CHECK((in_body(estimated.poses()[b], up) - in_body(true_skeleton.poses()[b], up)).norm() <
          0.02);
    CHECK((in_body(estimated.poses()[b], estimated.twists()[b].angular_rad_per_s) -
           in_body(true_skeleton.poses()[b], true_skeleton.twists()[b].angular_rad_per_s))
              .norm() < 0.005);
  }
  CHECK_FALSE(filter.update_gravity(2, -up, 1e-2));  // upside down: rejected
}

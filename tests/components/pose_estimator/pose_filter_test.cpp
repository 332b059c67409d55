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
    for (const auto& joint : model_.tree().joints) now_.push_back(sim::initial_reading(joint));
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
    VectorXd pull = -4 * offset_ - 2 * speed_;
    const VectorXd f = distribution_.distribute(model_.jacobian(), bias + inertia * pull);
    VectorXd torque = -bias - model_.jacobian().transpose() * f;
    for (std::size_t j = 0; j < now_.size(); ++j)
      for (int d = 0; d < sim::coordinates_of(now_[j].type); ++d) {
        const int i = model_.skeleton().first_of(int(j)) + d;
        const double viscous = model_.tree().joints[j].viscous_Nm_s_per_rad;
        torque[i] -= viscous * speed_[i], inertia(i, i) += viscous * dt_s;
      }
    speed_ += dt_s * inertia.llt().solve(torque);
    const VectorXd pushed =
        VectorXd::NullaryExpr(speed_.size(), [&] { return sigma * normal_(random_); });
    turn(dt_s * speed_ + 0.5 * dt_s * dt_s * pushed);
    speed_ += dt_s * pushed;
    place();
    return f;
  }
  double length_m(int a, double sigma) { return model_.length_m()[a] + sigma * normal_(random_); }
  /// (δ, ε) of the filter.
  VectorXd error_of(const pose::PoseFilter& filter) const {
    VectorXd e(2 * speed_.size());
    for (std::size_t j = 0; j < now_.size(); ++j) {
      const auto& seen = filter.joints()[j];
      const auto way = sim::displacement(now_[j].type, seen.position, now_[j].position);
      const int first = model_.skeleton().first_of(int(j));
      for (int d = 0; d < sim::coordinates_of(now_[j].type); ++d)
        e[first + d] = way[std::size_t(d)];
    }
    e.tail(speed_.size()) = speed_ - filter.speed_rad_per_s();
    return e;
  }
  std::vector<sim::JointReading> now_;

 private:
  void disturb_start() {
    offset_.setZero(speed_.size());
    turn(VectorXd::NullaryExpr(speed_.size(), [&] { return 0.05 * normal_(random_); }));
    speed_ = VectorXd::NullaryExpr(speed_.size(), [&] { return 0.1 * normal_(random_); });
    place();
  }
  void turn(const VectorXd& by) {
    offset_ += by;
    for (std::size_t j = 0; j < now_.size(); ++j) {
      std::array<double, 3> way{};
      const int first = model_.skeleton().first_of(int(j));
      for (int d = 0; d < sim::coordinates_of(now_[j].type); ++d)
        way[std::size_t(d)] = by[first + d];
      now_[j].position = sim::displaced(now_[j].type, now_[j].position, way);
    }
  }
  void place() {
    for (std::size_t j = 0; j < now_.size(); ++j)
      for (int d = 0; d < sim::coordinates_of(now_[j].type); ++d)
        now_[j].velocity_rad_per_s[std::size_t(d)] = speed_[model_.skeleton().first_of(int(j)) + d];
    model_.place(now_);
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

/// A tendon whose measured length is stuck, with an offset `off_m`.
struct Dead {
  int tendon = -1;
  double off_m = 0;
};

/// eᵀ P⁻¹ e of one run of half a second.
double run(unsigned seed, const Dead& dead = {}, double* worst_rad = nullptr) {
  Truth truth(seed);
  pose::PoseFilter filter(arm(), options);
  const double stuck_m = truth.length_m(std::max(dead.tendon, 0), 0) + dead.off_m;
  for (int k = 0; k < 250; ++k) {
    const VectorXd f = truth.move(dt_s, options.acceleration_rad_per_s2);
    filter.predict(dt_s, f);
    for (int a = 0; a < 11; ++a)
      filter.update_length(a, a == dead.tendon ? stuck_m : truth.length_m(a, sigma_m), sigma_m);
    filter.apply_correction();
  }
  const VectorXd e = truth.error_of(filter);
  if (worst_rad) *worst_rad = std::max(*worst_rad, e.head(4).cwiseAbs().maxCoeff());
  return e.dot(filter.covariance().llt().solve(e));
}

}  // namespace

TEST_CASE("the filter's covariance is consistent: NEES over 60 runs") {
  double sum = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) sum += run(seed);
  // χ² of 60 × 8 degrees of freedom, divided by 60: 8 ± 0.5; 99.9 % within
  CHECK(sum / 60 > 6.4);
  CHECK(sum / 60 < 9.8);
}

TEST_CASE("a length error of 20 mm is rejected, and a stuck sensor causes at most 2 degrees") {
  for (int tendon = 0; tendon < 11; ++tendon) {
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

TEST_CASE("a joint measurement as uncertain as the start moves the estimate halfway") {
  pose::PoseFilter filter(arm(), options);
  CHECK(filter.update_joint(1, {0.34}, 0.05));  // as uncertain as the start
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
  const auto& there = truth.skeleton();
  const sim::Vec3 up(0, 0, 9.81);
  const auto in_body = [](const sim::BodyPose& pose, const sim::Vec3& v) -> sim::Vec3 {
    return pose.rotation.transpose() * v;
  };
  for (int k = 0; k < 30; ++k) {
    for (const int body : {1, 2}) {
      const auto b = std::size_t(body);
      filter.update_angular_velocity(
          body, in_body(there.poses()[b], there.twists()[b].angular_rad_per_s), 1e-3);
      filter.update_gravity(body, in_body(there.poses()[b], up), 1e-2);
    }
    filter.apply_correction();
  }
  for (const std::size_t b : {1U, 2U}) {
    const auto& seen = filter.model().skeleton();
    CHECK((in_body(seen.poses()[b], up) - in_body(there.poses()[b], up)).norm() < 0.02);
    CHECK((in_body(seen.poses()[b], seen.twists()[b].angular_rad_per_s) -
           in_body(there.poses()[b], there.twists()[b].angular_rad_per_s))
              .norm() < 0.005);
  }
  CHECK_FALSE(filter.update_gravity(2, -up, 1e-2));  // upside down: rejected
}

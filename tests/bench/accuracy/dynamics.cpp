#include "sim/model/skeleton/skeleton_model.hpp"
#include "sim/world/bullet_skeleton.hpp"
#include "tests/bench/accuracy/figure.hpp"
#include "tests/sim/random_robots.hpp"

namespace accuracy {
namespace {

using sim::Vec3;

const Vec3 gravity_m_per_s2(0.3, -0.2, -9.81);  // chosen: not parallel to an axis

/// Largest errors of all robots.
struct Errors {
  double round_trip_rad_per_s2 = 0, inertia = 0, acceleration = 0;
};

void compare(rigs::Draw& draw, Errors& worst) {
  const sim::RobotTree tree(rigs::random_trees(draw));
  sim::SkeletonModel model(tree, gravity_m_per_s2);
  sim::BulletSkeleton bullet(tree, gravity_m_per_s2, {});
  bullet.place(rigs::posture(tree.joints, draw));
  model.place(bullet.joints());

  // τ = H a + C + τ_G  ⇔  a = H⁻¹ (τ − C − τ_G)
  const int n = model.coordinates();
  const Eigen::VectorXd a = Eigen::VectorXd::NullaryExpr(n, [&] { return draw.between(-5, 5); });
  Eigen::VectorXd tau;
  model.inverse(a, tau);
  worst.round_trip_rad_per_s2 =
      larger(worst.round_trip_rad_per_s2, (model.forward(tau) - a).cwiseAbs().maxCoeff());

  // H H⁻¹ = 1, and the accelerations without torques
  const auto peer = bullet.respond();
  Eigen::MatrixXd h;
  model.inertia(h);
  const Eigen::MatrixXd residual = h * peer.inverse_inertia - Eigen::MatrixXd::Identity(n, n);
  worst.inertia = larger(worst.inertia, residual.cwiseAbs().maxCoeff());
  const Eigen::VectorXd free_acceleration = model.forward(Eigen::VectorXd::Zero(n));
  worst.acceleration = larger(worst.acceleration, (free_acceleration - peer.acceleration).norm() /
                                                      free_acceleration.norm());
}

}  // namespace

Figures dynamics() {
  rigs::Draw draw(8);  // chosen
  Errors worst;
  for (int robot = 0; robot < 20; ++robot) compare(draw, worst);
  return {{8, "accelerations through inverse and forward dynamics, 20 robots",
           worst.round_trip_rad_per_s2, 1e-9, "rad/s²"},
          {8, "H times the inverse of Bullet's H, minus identity", worst.inertia, 1e-9, ""},
          {8, "accelerations against Bullet's, relative", worst.acceleration, 1e-9, ""}};
}

}  // namespace accuracy

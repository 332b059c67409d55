#include "sim/model/skeleton/skeleton_model.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "sim/world/bullet_skeleton.hpp"
#include "tests/sim/random_robots.hpp"
#include "tests/sim/skeletons.hpp"

using namespace sim;
using rigs::Draw, rigs::posture, rigs::random_trees;

namespace {

const Vec3 down(0.3, -0.2, -9.81);  // not along an axis

Eigen::VectorXd random_vector(int n, Draw& draw) {
  return Eigen::VectorXd::NullaryExpr(n, [&] { return draw.between(-5, 5); });
}

}  // namespace

TEST_CASE("forward dynamics is the inverse of inverse dynamics") {
  Draw draw(1);
  for (int i = 0; i < 20; ++i) {
    const RobotTree tree(random_trees(draw));
    SkeletonModel model(tree, down);
    model.place(posture(tree.joints, draw));
    const Eigen::VectorXd a = random_vector(model.coordinates(), draw);
    Eigen::VectorXd tau;
    model.inverse(a, tau);
    CHECK((model.forward(tau) - a).cwiseAbs().maxCoeff() < 1e-9);
  }
}

TEST_CASE("inertia and acceleration agree with Bullet to 1e-9") {
  Draw draw(2);
  for (int i = 0; i < 20; ++i) {
    const RobotTree tree(random_trees(draw));
    SkeletonModel model(tree, down);
    BulletSkeleton bullet(tree, down, {});
    const auto joints = posture(tree.joints, draw);
    bullet.place(joints);
    model.place(bullet.joints());
    const auto response = bullet.respond();
    Eigen::MatrixXd h;
    model.inertia(h);
    const auto n = model.coordinates();
    REQUIRE(response.acceleration.size() == n);
    CHECK((h * response.inverse_inertia - Eigen::MatrixXd::Identity(n, n)).cwiseAbs().maxCoeff() <
          1e-9);
    const Eigen::VectorXd a = model.forward(Eigen::VectorXd::Zero(n));
    CHECK((a - response.acceleration).norm() < 1e-9 * a.norm());
    for (std::size_t k = 2; k < tree.bodies.size(); ++k) {
      const BodyPose& pose = model.poses()[k];
      const auto& com = tree.bodies[k].body.com_m;
      const Vec3 at = pose.position_m + pose.rotation * Vec3(com[0], com[1], com[2]);
      CHECK((at - response.com_m[k]).norm() < 1e-12);
    }
  }
}

TEST_CASE("the torques of a force have the same power as the force") {
  Draw draw(3);
  const RobotTree tree(random_trees(draw));
  SkeletonModel model(tree, down);
  const auto joints = posture(tree.joints, draw);
  model.place(joints);
  Eigen::VectorXd v = Eigen::VectorXd::Zero(model.coordinates());
  for (std::size_t j = 0; j < joints.size(); ++j)
    if (const int first = model.first_of(static_cast<int>(j)); first >= 0)
      for (int d = 0; d < (joints[j].type == erp::JointType::spherical ? 3 : 1); ++d)
        v[first + d] = joints[j].velocity_rad_per_s[static_cast<std::size_t>(d)];
  for (int body = 0; body < static_cast<int>(tree.bodies.size()); ++body) {
    const Vec3 at(0.2, -0.1, 0.4), force(3, 5, -2);
    Eigen::VectorXd tau = Eigen::VectorXd::Zero(model.coordinates());
    for (const int d : model.movers(body)) tau[d] = model.axis(d).dot(sim::wrench(at, force));
    const BodyTwist& twist = model.twists()[static_cast<std::size_t>(body)];
    const Vec3 arm = at - model.poses()[static_cast<std::size_t>(body)].position_m;
    const double power_W = force.dot(twist.linear_m_per_s + twist.angular_rad_per_s.cross(arm));
    CHECK(tau.dot(v) == Approx(power_W).margin(1e-12));
  }
}

TEST_CASE(
    "a pendulum at rest requires the torque m g l sin q, and a locked joint has no coordinate") {
  const RobotTree tree(rigs::pendulum(0.5));
  SkeletonModel model(tree, Vec3(0, 0, -9.81));
  Eigen::VectorXd tau;
  model.gravity_torques(tau);
  REQUIRE(tau.size() == 1);
  CHECK(std::abs(tau[0]) ==
        Approx(rigs::pendulum_mass_kg * 9.81 * rigs::pendulum_l_m * std::sin(0.5)));
  const std::vector<std::string> lock{"hinge"};
  SkeletonModel locked(tree, Vec3(0, 0, -9.81), lock);
  CHECK(locked.coordinates() == 0);
  CHECK((locked.poses()[1].rotation - model.poses()[1].rotation).norm() < 1e-15);
  const std::vector<std::string> unknown_joint{"knee"};
  CHECK_THROWS_WITH(SkeletonModel(tree, down, unknown_joint), Catch::Contains("knee"));
}

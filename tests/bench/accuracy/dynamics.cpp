#include <Eigen/Geometry>
#include <random>

#include "sim/skeleton/skeleton_model.hpp"
#include "sim/world/bullet_skeleton.hpp"
#include "tests/bench/accuracy/figure.hpp"
#include "tests/sim/skeletons.hpp"

namespace accuracy {
namespace {

using sim::JointReading, sim::Vec3;

const Vec3 gravity_m_per_s2(0.3, -0.2, -9.81);  // chosen: along no axis

class Draw {
 public:
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  xml::Vec3 vector(double size) {
    return {between(-size, size), between(-size, size), between(-size, size)};
  }

 private:
  std::mt19937 random_{8};
};

/// Two trees of eight bodies, with branches: every third joint a ball's, every fifth fixed. Chosen.
erp::Robot thicket(Draw& draw) {
  std::vector<erp::Body> bodies{rigs::root("left"), rigs::root("right")};
  std::vector<erp::Joint> joints;
  for (int k = 0; k < 16; ++k) {
    const std::string name = "bone_" + std::to_string(k);
    const std::string parent = bodies[static_cast<std::size_t>(k < 2 ? k : k + 1 - k % 2)].name;
    const xml::Vec3 inertia_kg_m2{draw.between(0.01, 0.02), draw.between(0.01, 0.02),
                                  draw.between(0.012, 0.018)};
    bodies.push_back(rigs::bone(name, draw.between(0.3, 3), draw.vector(0.1), inertia_kg_m2));
    const auto type = k % 5 == 4   ? erp::JointType::fixed
                      : k % 3 == 0 ? erp::JointType::spherical
                                   : erp::JointType::revolute;
    joints.push_back(
        rigs::joint("joint_" + std::to_string(k), type, parent, name, draw.vector(0.3)));
    joints.back().axis = draw.vector(1);
    joints.back().initial_rad = draw.between(-1, 1);
  }
  return rigs::robot(bodies, joints);
}

JointReading any_reading(const erp::Joint& joint, Draw& draw) {
  JointReading reading = sim::start_of(joint);
  for (double& v : reading.velocity_rad_per_s) v = draw.between(-3, 3);
  if (joint.type == erp::JointType::revolute) reading.position[0] = draw.between(-2, 2);
  if (joint.type == erp::JointType::spherical) {
    const xml::Vec3 v = draw.vector(1);
    const Eigen::Quaterniond q =
        Eigen::Quaterniond(draw.between(0.1, 1), v[0], v[1], v[2]).normalized();
    reading.position = {q.w(), q.x(), q.y(), q.z()};
  }
  return reading;
}

/// The worst of all robots.
struct Errors {
  double round_trip_rad_per_s2 = 0, inertia = 0, acceleration = 0;
};

void compare(Draw& draw, Errors& worst) {
  const sim::RobotTree tree(thicket(draw));
  sim::SkeletonModel model(tree, gravity_m_per_s2);
  sim::BulletSkeleton bullet(tree, gravity_m_per_s2, {});
  std::vector<JointReading> joints;
  for (const erp::Joint& joint : tree.joints) joints.push_back(any_reading(joint, draw));
  bullet.place(joints);
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
  const Eigen::MatrixXd left = h * peer.inverse_inertia - Eigen::MatrixXd::Identity(n, n);
  worst.inertia = larger(worst.inertia, left.cwiseAbs().maxCoeff());
  const Eigen::VectorXd falling = model.forward(Eigen::VectorXd::Zero(n));
  worst.acceleration =
      larger(worst.acceleration, (falling - peer.acceleration).norm() / falling.norm());
}

}  // namespace

Figures dynamics() {
  Draw draw;
  Errors worst;
  for (int robot = 0; robot < 20; ++robot) compare(draw, worst);
  return {{8, "accelerations through inverse and forward dynamics, 20 robots",
           worst.round_trip_rad_per_s2, 1e-9, "rad/s²"},
          {8, "H times the inverse of Bullet's, less 1", worst.inertia, 1e-9, ""},
          {8, "accelerations beside Bullet's, relative", worst.acceleration, 1e-9, ""}};
}

}  // namespace accuracy

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "sim/world/world.hpp"
#include "tests/sim/formats/mujoco.hpp"
#include "tests/sim/skeletons.hpp"

using sim::JointReading, sim::World;

namespace {

erp::Robot arm(bool with_friction) {
  erp::Robot robot = erp::read_robot(rigs::config("arm/robot.xml"));
  for (auto& joint : robot.skeletons[0].joints)
    if (!with_friction) joint.coulomb_Nm = 0;  // MuJoCo's Coulomb friction is softened
  return robot;
}

void set_joint_of_both(const reference::Mujoco& mujoco, World& world, int joint,
                       const JointReading& reading) {
  world.set_joint(joint, reading);
  double* q = mujoco.position_of(world.joint_list()[joint].name);
  const int n = reading.type == erp::JointType::spherical ? 4 : 1;
  for (int i = 0; i < n; ++i) q[i] = reading.position[static_cast<std::size_t>(i)];
}

/// True if MuJoCo's tendon passes straight through its sphere. MuJoCo 2.2.2 occasionally does this
/// for a tendon with a sidesite, with a jump of the length to the distance of the end points.
bool penetrates(const sim::PathShape& shape, double mujoco_length_m) {
  if (shape.elements != 3 || !shape.touches[1]) return false;
  const Eigen::Vector3d a = shape.entry_m[0], b = shape.entry_m[2], along = b - a;
  const Eigen::Vector3d center = shape.pulls[1].at_m;
  const double t = along.dot(center - a) / along.squaredNorm();
  const double radius = (shape.entry_m[1] - center).norm();
  return std::abs(along.norm() - mujoco_length_m) < 1e-9 &&
         (a + t * along - center).norm() < radius - 1e-6;
}

}  // namespace

TEST_CASE("wrapped lengths on spheres agree with MuJoCo to 1e-9 m") {
  World world(arm(false));
  const reference::Mujoco mujoco(world.robot());
  std::mt19937 random(3);
  std::uniform_real_distribution<double> angle(-0.7, 0.7), bend(0, 2.2);
  int compared = 0, penetrated = 0;
  double largest_m = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    const Eigen::Quaterniond q = Eigen::AngleAxisd(angle(random), Eigen::Vector3d::UnitX()) *
                                 Eigen::AngleAxisd(angle(random), Eigen::Vector3d::UnitY()) *
                                 Eigen::AngleAxisd(angle(random), Eigen::Vector3d::UnitZ());
    set_joint_of_both(mujoco, world, 0,
                      {erp::JointType::spherical, {q.w(), q.x(), q.y(), q.z()}, {}});
    set_joint_of_both(mujoco, world, 1, {erp::JointType::revolute, {bend(random)}, {}});
    mj_forward(mujoco.model.get(), mujoco.data.get());
    for (std::size_t k = 0; k < world.actuators().size(); ++k) {
      const double mujoco_m = mujoco.length_m(world.robot().actuators[k].name);
      if (++compared; penetrates(world.path(static_cast<int>(k)), mujoco_m)) {
        ++penetrated;
        continue;
      }
      CAPTURE(trial, world.robot().actuators[k].name);
      largest_m = std::max(largest_m, std::abs(world.actuators()[k].length_m - mujoco_m));
      CHECK(largest_m < 1e-9);
    }
  }
  WARN("largest difference of a length: "
       << largest_m << " m; " << penetrated << " of " << compared
       << " not compared, because MuJoCo's tendon passes through the pulley");
  CHECK(penetrated < compared / 100);
}

TEST_CASE("lengths around an inclined cylinder agree with MuJoCo to 1e-9 m") {
  erp::Robot robot = erp::read_robot(rigs::config("hinge_rig/robot.xml"));
  erp::Pulley cylinder{{}, "base", {0, 0, 0}, 0.02};
  cylinder.shape = erp::PulleyShape::cylinder;
  cylinder.axis = {0.3, -1, 0.2};
  robot.actuators[0].tendon.path = {erp::Attach{{}, "base", {-0.05, 0.03, 0.2}}, cylinder,
                                    erp::Attach{{}, "forearm", {0.02, -0.04, -0.1}}};
  World world(robot);
  const reference::Mujoco mujoco(world.robot());
  int wrapped = 0;
  for (double q = -1.2; q < 1.6; q += 0.01) {
    set_joint_of_both(mujoco, world, 0, {erp::JointType::revolute, {q}, {}});
    mj_forward(mujoco.model.get(), mujoco.data.get());
    CAPTURE(q);
    CHECK(std::abs(world.actuators()[0].length_m - mujoco.length_m("flexor")) < 1e-9);
    wrapped += world.path(0).touches[1];
  }
  CHECK(wrapped > 100);
}

TEST_CASE("with equal tensions the motion of the arm agrees with MuJoCo to 1e-3 rad over 1 s") {
  World world(arm(false));
  const reference::Mujoco mujoco(world.robot());
  const double dt_s = 1e-4;
  mujoco.model->opt.timestep = dt_s;
  std::vector<double> tension_N;
  for (const auto& actuator : world.robot().actuators)
    tension_N.push_back(actuator.tendon.pretension_N + 3);
  std::copy(tension_N.begin(), tension_N.end(), mujoco.data->ctrl);
  double largest_rad = 0, moved_rad = 0;
  for (int i = 0; i < 10000; ++i) {
    world.step_pulled(tension_N, dt_s);
    mj_step(mujoco.model.get(), mujoco.data.get());
    const auto& ball = world.joints()[0].position;
    const double* mujoco_values = mujoco.position_of("shoulder");
    double dot_product = 0;
    for (int k = 0; k < 4; ++k) dot_product += ball[static_cast<std::size_t>(k)] * mujoco_values[k];
    largest_rad =
        std::max({largest_rad, 2 * std::acos(std::min(1.0, std::abs(dot_product))),
                  std::abs(world.joints()[1].position[0] - *mujoco.position_of("elbow"))});
    moved_rad = std::max(moved_rad, 2 * std::acos(std::min(1.0, std::abs(ball[0]))));
  }
  WARN("largest difference of an angle: " << largest_rad << " rad, moved " << moved_rad << " rad");
  CHECK(moved_rad > 0.1);
  CHECK(largest_rad < 1e-3);
}

namespace {

/// A free bone made of solids and a second bone on a hinge, each pulled by one tendon.
erp::Robot floating() {
  erp::Body blade, rod;
  blade.name = "blade", rod.name = "rod";
  blade.density_kg_per_m3 = rod.density_kg_per_m3 = 1130;
  blade.parts = {erp::Capsule{{}, {0.02, 0, 0}, {0.08, 0.05, -0.1}, 0.02},
                 erp::Weight{{}, {-0.03, 0.02, 0.01}, 0.25}};
  rod.parts = {erp::Capsule{{}, {0, 0, 0}, {0.05, 0, -0.2}, 0.015}};
  erp::Joint hinge =
      rigs::joint("hinge", erp::JointType::revolute, "blade", "rod", {0.08, 0.05, 0});
  hinge.axis = {1, 2, 0.5};
  erp::Robot robot = rigs::robot(
      {rigs::root(), blade, rod},
      {rigs::joint("float", erp::JointType::free, "base", "blade", {0.1, 0.2, 1.5}), hinge});
  robot.motor_types = {rigs::caliper()};
  const auto pull = [&](const char* name, xml::Vec3 from, const char* body, xml::Vec3 to) {
    erp::Actuator a;
    a.name = name, a.motor = "caliper_12V", a.spindle.radius_m = 0.0045, a.max_tension_N = 100;
    a.tendon.stiffness_N_per_m = 6000;
    a.tendon.path = {erp::Attach{{}, "base", from}, erp::Attach{{}, body, to}};
    robot.actuators.push_back(a);
  };
  pull("up", {0.1, 0.2, 2.5}, "blade", {0.05, 0, 0.02});
  pull("aside", {1.1, 0.2, 2}, "rod", {0.05, 0, -0.2});
  return robot;
}

}  // namespace

TEST_CASE("the motion of a free body with a hinged body agrees with MuJoCo to 1e-3 m over 0.5 s") {
  World world(floating());
  const reference::Mujoco mujoco(world.robot());
  const double dt_s = 2e-5;
  mujoco.model->opt.timestep = dt_s;
  const std::vector<double> tension_N{12, 3};
  std::copy(tension_N.begin(), tension_N.end(), mujoco.data->ctrl);
  double largest_m = 0, turned_rad = 0;
  for (int i = 0; i < 25000; ++i) {
    world.step_pulled(tension_N, dt_s);
    mj_step(mujoco.model.get(), mujoco.data.get());
    for (const int body : {1, 2}) {
      const double* mujoco_values =
          mujoco.data->xpos + 3 * (body + 1);  // after the world and the base
      const Eigen::Vector3d at = world.poses()[static_cast<std::size_t>(body)].position_m;
      largest_m = std::max(
          largest_m,
          (at - Eigen::Vector3d(mujoco_values[0], mujoco_values[1], mujoco_values[2])).norm());
    }
    turned_rad = std::max(turned_rad, std::abs(world.joints()[1].position[0]));
  }
  WARN("largest difference of a position: " << largest_m << " m; the hinge turned " << turned_rad
                                            << " rad");
  CHECK(turned_rad > 0.3);
  CHECK(largest_m < 1e-3);
}

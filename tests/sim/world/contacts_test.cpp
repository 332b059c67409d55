#include <catch2/catch.hpp>

#include "sim/world/world.hpp"
#include "tests/sim/skeletons.hpp"

using Eigen::Vector3d;
using sim::JointReading, sim::World;

namespace {

erp::Body solid(const std::string& name, erp::Part part) {
  erp::Body body;
  body.name = name, body.density_kg_per_m3 = 1130;
  body.parts = {std::move(part)};
  return body;
}

/// Free bodies at given positions, each in contact with the previous one; the first is fixed.
erp::Robot free_bodies(std::vector<erp::Body> bodies, const std::vector<xml::Vec3>& at,
                       xml::Vec3 gravity = {0, 0, -9.81}) {
  std::vector<erp::Joint> joints;
  for (std::size_t k = 1; k < bodies.size(); ++k)
    joints.push_back(rigs::joint("j" + std::to_string(k), erp::JointType::free, bodies[0].name,
                                 bodies[k].name, at[k]));
  bodies[0].density_kg_per_m3.reset();
  erp::Robot robot = rigs::robot(bodies, joints, gravity);
  for (std::size_t k = 1; k < bodies.size(); ++k)
    robot.skeletons[0].contacts.push_back({{}, bodies[k].name, bodies[k - 1].name});
  return robot;
}

erp::Body floor() { return solid("floor", erp::Box{{}, {0, 0, -0.05}, {2, 2, 0.1}}); }
erp::Body ball(const std::string& name = "ball") {
  return solid(name, erp::Sphere{{}, {0, 0, 0}, 0.03});
}

double lowest_m(World& world, int body, int steps) {
  double lowest = 1e9;
  for (int i = 0; i < steps; ++i) {
    world.step({}, 0.001);
    lowest = std::min(lowest, world.poses()[body].position_m.z());
  }
  return lowest;
}

}  // namespace

TEST_CASE("a ball that falls on a floor stops on the floor and stays there") {
  World world(free_bodies({floor(), ball()}, {{}, {0.1, 0.2, 0.5}}));
  CHECK(lowest_m(world, 1, 2000) > 0.03 - 1e-6);
  CHECK(world.poses()[1].position_m.z() == Approx(0.03).margin(1e-6));
  for (const double v : world.joints()[0].slide_m_per_s) CHECK(std::abs(v) < 1e-6);
}

TEST_CASE("a capsule rests on the floor along its whole length") {
  erp::Body rod = solid("rod", erp::Capsule{{}, {-0.1, 0, 0}, {0.1, 0, 0.02}, 0.02});
  World world(free_bodies({floor(), rod}, {{}, {0, 0, 0.3}}));
  for (int i = 0; i < 3000; ++i) world.step({}, 0.001);
  const sim::BodyPose& pose = world.poses()[1];
  for (const Vector3d& end : {Vector3d(-0.1, 0, 0), Vector3d(0.1, 0, 0.02)})
    CHECK((pose.position_m + pose.rotation * end).z() > 0.02 - 5e-4);
}

TEST_CASE("without a contact bodies pass through each other") {
  erp::Robot robot = free_bodies({floor(), ball()}, {{}, {0, 0, 0.1}});
  robot.skeletons[0].contacts.clear();
  World world(robot);
  CHECK(lowest_m(world, 1, 500) < -0.5);
}

TEST_CASE("two colliding balls move together afterwards, and momentum is conserved to rounding") {
  World world(
      free_bodies({floor(), ball("a"), ball("b")}, {{}, {0, 0, 1}, {0.1, 0.01, 1}}, {0, 0, 0}));
  JointReading moving = world.joints()[0];
  moving.slide_m_per_s = {2, 0, 0};
  world.set_joint(0, moving);
  double nearest = 1;
  for (int i = 0; i < 300; ++i) {
    world.step({}, 0.001);
    nearest = std::min(nearest, (world.poses()[1].position_m - world.poses()[2].position_m).norm());
  }
  CHECK(nearest == Approx(0.06).margin(1e-4));
  const auto &a = world.joints()[0].slide_m_per_s, &b = world.joints()[1].slide_m_per_s;
  CHECK(a[0] + b[0] == Approx(2).epsilon(1e-9));
  CHECK(std::abs(a[1] + b[1]) < 1e-9);
  CHECK(b[0] > 0.9);
  CHECK(b[1] > 0.05);  // pushed aside, because it is not hit at its centre
}

TEST_CASE("bodies that start in overlap separate slowly") {
  for (const double depth : {0.001, 0.02, 0.05}) {
    CAPTURE(depth);
    World world(free_bodies({floor(), ball("a"), ball("b")}, {{}, {0, 0, 1}, {0.06 - depth, 0, 1}},
                            {0, 0, 0}));
    double fastest = 0;
    for (int i = 0; i < 500; ++i) {
      world.step({}, 0.001);
      fastest = std::max(fastest, std::abs(world.joints()[1].slide_m_per_s[0]));
    }
    CHECK((world.poses()[1].position_m - world.poses()[2].position_m).norm() > 0.06 - 1e-5);
    CHECK(fastest <= 0.2 * depth / 0.001 + 1e-9);
  }
}

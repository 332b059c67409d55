#include "sim/skeleton/joint_path.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "sim/skeleton/spatial.hpp"
#include "tests/sim/rigs.hpp"

namespace {

using Eigen::Quaterniond;
using sim::Vec3;

/// The arm's joints: shoulder, elbow.
const std::vector<erp::Joint>& joints() {
  static const auto list = erp::read_robot(rigs::config("arm/robot.xml")).joints();
  return list;
}
sim::Pose pose(double angle, const Vec3& axis, double elbow) {
  const Quaterniond q(Eigen::AngleAxisd(angle, axis.normalized()));
  return {{q.w(), q.x(), q.y(), q.z()}, {elbow}};
}
Quaterniond turn(const sim::JointMotion& m) {
  const auto& p = m.now.position;
  return {p[0], p[1], p[2], p[3]};
}
Vec3 vec(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

sim::JointPath three_poses() {
  return {joints(),
          {{1, pose(0, Vec3::UnitX(), 0.3)},
           {3, pose(1.2, {1, 2, -1}, 1.5)},
           {4, pose(-2.0, {0.5, -1, 0.2}, 0.3)}}};
}

}  // namespace

TEST_CASE("a way passes its poses at their times, at rest, and stays in the last") {
  const auto path = three_poses();
  std::vector<sim::JointMotion> at;
  for (const double t : {0.0, 1.0, 3.0, 4.0, 9.0}) {
    path.at(t, at);
    CHECK(vec(at[0].now.velocity_rad_per_s).norm() < 1e-12);
    CHECK(at[1].now.velocity_rad_per_s[0] == Approx(0).margin(1e-12));
    CHECK(at[1].now.position[0] == Approx(t == 3 ? 1.5 : 0.3));
  }
  const Quaterniond last(Eigen::AngleAxisd(-2.0, Vec3(0.5, -1, 0.2).normalized()));
  CHECK(turn(at[0]).angularDistance(last) < 1e-9);
  CHECK(path.end_s() == 4);
}

TEST_CASE("velocity and acceleration are the derivatives of where it is, ball joints included") {
  const auto path = three_poses();
  std::vector<sim::JointMotion> before, at, after;
  constexpr double h = 1e-5;
  for (double t = 1.05; t < 3.95; t += 0.1) {
    if (std::abs(t - 3) < 2 * h) continue;
    path.at(t - h, before), path.at(t, at), path.at(t + h, after);
    const Vec3 turned = vec(sim::way_between(erp::JointType::spherical, before[0].now.position,
                                             after[0].now.position)) /
                        (2 * h);
    CHECK((turned - vec(at[0].now.velocity_rad_per_s)).norm() < 1e-7);
    const Vec3 faster =
        (vec(after[0].now.velocity_rad_per_s) - vec(before[0].now.velocity_rad_per_s)) / (2 * h);
    CHECK((faster - vec(at[0].acceleration_rad_per_s2)).norm() < 1e-5);
    CHECK((after[1].now.position[0] - before[1].now.position[0]) / (2 * h) ==
          Approx(at[1].now.velocity_rad_per_s[0]).margin(1e-7));
    CHECK((after[1].now.velocity_rad_per_s[0] - before[1].now.velocity_rad_per_s[0]) / (2 * h) ==
          Approx(at[1].acceleration_rad_per_s2[0]).margin(1e-5));
  }
}

TEST_CASE("a ball joint takes the shorter way round") {
  const auto far = pose(3.0, Vec3::UnitZ(), 0)[0], back = pose(-3.0, Vec3::UnitZ(), 0)[0];
  const Vec3 way = vec(sim::way_between(erp::JointType::spherical, far, back));
  CHECK(way.z() == Approx(2 * std::numbers::pi - 6));
  const auto there = sim::gone(erp::JointType::spherical, far, {way.x(), way.y(), way.z()});
  CHECK(vec(sim::way_between(erp::JointType::spherical, there, back)).norm() < 1e-12);
}

TEST_CASE("times that do not rise are refused, with the row") {
  const auto p = pose(0, Vec3::UnitX(), 0);
  CHECK_THROWS_WITH((sim::JointPath{joints(), {{0, p}, {1, p}, {1, p}}}), Catch::Contains("row 3"));
  CHECK_THROWS_AS((sim::JointPath{joints(), {}}), std::invalid_argument);
}

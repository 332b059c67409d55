#include "sim/model/skeleton/joint_path.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "sim/model/skeleton/catch_up.hpp"
#include "sim/model/skeleton/spatial.hpp"
#include "tests/sim/rigs.hpp"

namespace {

using Eigen::Quaterniond;
using sim::vec, sim::Vec3;

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

sim::JointPath three_poses(sim::Via via = sim::Via::rest) {
  return {joints(),
          {{1, pose(0, Vec3::UnitX(), 0.3)},
           {3, pose(1.2, {1, 2, -1}, 1.5)},
           {4, pose(-2.0, {0.5, -1, 0.2}, 0.3)}},
          via};
}

/// Two consecutive equal poses: a stop in a trajectory with Via::through.
sim::JointPath with_a_stop() {
  const auto p = pose(0.7, {0, 1, 1}, 0.9);
  return {joints(),
          {{0, pose(0, Vec3::UnitX(), 0.3)},
           {1, pose(0.5, {1, 0, 1}, 1.2)},
           {2, p},
           {3, p},
           {4, pose(1, {1, 1, 0}, 0.1)}},
          sim::Via::through};
}

/// Compares velocity and acceleration at a time with difference quotients; calls where(t, motions).
void check_derivatives(const auto& where, double t) {
  std::vector<sim::JointMotion> before, at, after;
  constexpr double h = 1e-5;
  where(t - h, before), where(t, at), where(t + h, after);
  for (std::size_t j = 0; j < at.size(); ++j) {
    const Vec3 velocity =
        vec(sim::displacement(at[j].now.type, before[j].now.position, after[j].now.position)) /
        (2 * h);
    CHECK((velocity - vec(at[j].now.velocity_rad_per_s)).norm() < 1e-7);
    const Vec3 acceleration =
        (vec(after[j].now.velocity_rad_per_s) - vec(before[j].now.velocity_rad_per_s)) / (2 * h);
    CHECK((acceleration - vec(at[j].acceleration_rad_per_s2)).norm() < 1e-5);
  }
}

/// ∫ jerk² dt of the elbow, from difference quotients.
double elbow_jerk(const sim::JointPath& path) {
  constexpr double h = 1e-3;
  std::vector<sim::JointMotion> a, b;
  double sum = 0;
  for (double t = path.begin_s(); t < path.end_s(); t += h) {
    path.at(t, a), path.at(t + h, b);
    const double jerk = (b[1].acceleration_rad_per_s2[0] - a[1].acceleration_rad_per_s2[0]) / h;
    sum += h * jerk * jerk;
  }
  return sum;
}

}  // namespace

TEST_CASE("a trajectory passes its poses at their times, at rest, and stays in the last pose") {
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

TEST_CASE("velocity and acceleration are the derivatives of the position, ball joints included") {
  const auto path = three_poses(GENERATE(sim::Via::rest, sim::Via::through));
  for (double t = 1.05; t < 3.95; t += 0.1)
    if (std::abs(t - 3) > 1e-4) check_derivatives([&](double s, auto& at) { path.at(s, at); }, t);
}

TEST_CASE(
    "CatchUp moves a robot from another position and velocity to the trajectory without a jump") {
  const auto path = three_poses(sim::Via::through);
  const auto start = pose(0.6, {0, 2, 1}, 0.9);
  std::vector<sim::JointReading> now{
      {erp::JointType::spherical, start[0], {0.4, -0.9, 0.7}, {}, {}},
      {erp::JointType::revolute, start[1], {-1.1}, {}, {}}};
  std::vector<sim::JointMotion> guided, desired;
  constexpr double begin_s = 1.7, duration_s = 0.8;
  path.at(begin_s, guided);
  const sim::CatchUp catch_up(now, guided, duration_s);
  const auto at = [&](double time_s, auto& motions) {
    path.at(time_s, motions), catch_up.add(time_s - begin_s, motions);
  };
  at(begin_s, guided);
  for (std::size_t j = 0; j < 2; ++j) {
    CHECK(vec(sim::displacement(now[j].type, guided[j].now.position, now[j].position)).norm() <
          1e-9);
    CHECK((vec(guided[j].now.velocity_rad_per_s) - vec(now[j].velocity_rad_per_s)).norm() < 1e-9);
  }
  for (double t = begin_s + 0.05; t < begin_s + duration_s; t += 0.1) check_derivatives(at, t);
  at(begin_s + duration_s - 1e-9, guided), path.at(begin_s + duration_s - 1e-9, desired);
  CHECK(turn(guided[0]).angularDistance(turn(desired[0])) < 1e-8);
  CHECK((vec(guided[0].acceleration_rad_per_s2) - vec(desired[0].acceleration_rad_per_s2)).norm() <
        1e-5);
  CHECK(guided[1].now.position[0] == Approx(desired[1].now.position[0]));
}

TEST_CASE("with Via::through, velocity and acceleration are continuous in the poses") {
  const auto path = three_poses(sim::Via::through);
  std::vector<sim::JointMotion> before, after, at_pose;
  constexpr double h = 1e-7;
  path.at(3 - h, before), path.at(3 + h, after), path.at(3, at_pose);
  CHECK(turn(at_pose[0])
            .angularDistance(Quaterniond(Eigen::AngleAxisd(1.2, Vec3(1, 2, -1).normalized()))) <
        1e-9);
  CHECK(at_pose[1].now.position[0] == Approx(1.5));
  for (std::size_t j = 0; j < 2; ++j) {
    const Vec3 velocity_change =
        vec(after[j].now.velocity_rad_per_s) - vec(before[j].now.velocity_rad_per_s);
    const Vec3 acceleration_change =
        vec(after[j].acceleration_rad_per_s2) - vec(before[j].acceleration_rad_per_s2);
    CHECK(velocity_change.norm() < 1e-4);
    CHECK(acceleration_change.norm() < 1e-3);
    CHECK(vec(at_pose[j].now.velocity_rad_per_s).norm() > 0.3);
  }
  for (const double end : {1.0, 4.0}) {
    path.at(end, at_pose);
    CHECK(vec(at_pose[0].now.velocity_rad_per_s).norm() < 1e-9);
    CHECK(at_pose[1].now.velocity_rad_per_s[0] == Approx(0).margin(1e-9));
  }
}

TEST_CASE("two consecutive equal poses are a stop with Via::through") {
  std::vector<sim::JointMotion> at;
  for (const double t : {2.0, 2.5, 3.0}) {
    with_a_stop().at(t, at);
    CHECK(at[1].now.position[0] == Approx(0.9));
    CHECK(vec(at[0].now.velocity_rad_per_s).norm() < 1e-9);
    CHECK(vec(at[1].acceleration_rad_per_s2).norm() < 1e-9);
  }
}

TEST_CASE("the trajectory through a point has minimum jerk") {
  const auto p = [](double elbow) { return pose(0, Vec3::UnitX(), elbow); };
  const sim::JointPath path(joints(), {{0, p(0)}, {1, p(1)}, {2, p(0)}}, sim::Via::through);
  std::vector<sim::JointMotion> at;
  path.at(1, at);
  CHECK(at[1].now.velocity_rad_per_s[0] == Approx(0).margin(1e-9));
  const double least_jerk = elbow_jerk(path);
  // An additional pose that is not on the trajectory must increase the jerk.
  path.at(0.5, at);
  for (const double offset_rad : {-0.02, 0.02}) {
    const sim::JointPath other(
        joints(), {{0, p(0)}, {0.5, p(at[1].now.position[0] + offset_rad)}, {1, p(1)}, {2, p(0)}},
        sim::Via::through);
    CHECK(elbow_jerk(other) > 1.0001 * least_jerk);
  }
  const sim::JointPath equal(joints(),
                             {{0, p(0)}, {0.5, p(at[1].now.position[0])}, {1, p(1)}, {2, p(0)}},
                             sim::Via::through);
  CHECK(elbow_jerk(equal) == Approx(least_jerk).epsilon(0.01));
}

TEST_CASE("a ball joint rotates by the smaller angle") {
  const auto from = pose(3.0, Vec3::UnitZ(), 0)[0], to = pose(-3.0, Vec3::UnitZ(), 0)[0];
  const Vec3 rotation = vec(sim::displacement(erp::JointType::spherical, from, to));
  CHECK(rotation.z() == Approx(2 * std::numbers::pi - 6));
  const auto displaced_position =
      sim::displaced(erp::JointType::spherical, from, {rotation.x(), rotation.y(), rotation.z()});
  CHECK(vec(sim::displacement(erp::JointType::spherical, displaced_position, to)).norm() < 1e-12);
}

TEST_CASE("times that do not increase are rejected with the row") {
  const auto p = pose(0, Vec3::UnitX(), 0);
  CHECK_THROWS_WITH((sim::JointPath{joints(), {{0, p}, {1, p}, {1, p}}}), Catch::Contains("row 3"));
  CHECK_THROWS_AS((sim::JointPath{joints(), {}}), std::invalid_argument);
}

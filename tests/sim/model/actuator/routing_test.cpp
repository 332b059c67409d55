#include "sim/model/actuator/routing.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "interfaces/robot/check.hpp"
#include "tests/sim/rigs.hpp"

using sim::BodyPose, sim::BodyTwist, sim::PathShape, sim::Routing, sim::Vec3;

namespace {

const std::vector<std::string> bodies{"base", "upper", "lower"};

erp::Attach attach(const std::string& body, xml::Vec3 at) { return {{}, body, at}; }
erp::Pulley pulley(const std::string& body, xml::Vec3 center, double r, xml::Vec3 side = {}) {
  return {{}, body, center, r, side};
}
erp::Tendon tendon(std::vector<std::variant<erp::Attach, erp::Pulley>> path) {
  erp::Tendon t = rigs::hinge_tendon();
  t.path = std::move(path);
  return t;
}

/// Two joints, with pulleys on different bodies and two consecutive pulleys.
Routing biarticular() {
  return Routing(tendon({attach("base", {0.02, 0.01, 0.2}), pulley("base", {0, 0, 0}, 0.03),
                         pulley("upper", {0.01, 0, -0.15}, 0.02), attach("upper", {0.03, 0, -0.2}),
                         pulley("lower", {0, 0, 0}, 0.025), attach("lower", {0.01, 0.02, -0.2})}),
                 bodies);
}

/// The same joints, over an inclined cylinder and a sphere with one additional turn.
Routing around_shafts() {
  erp::Pulley cylinder = pulley("base", {0.005, 0, 0}, 0.03);
  cylinder.shape = erp::PulleyShape::cylinder;
  cylinder.axis = {0.2, 1, -0.1};
  erp::Pulley drum = pulley("lower", {0, 0, 0}, 0.025);
  drum.axis = {0, 1, 0.1};
  drum.turns = 1;
  return Routing(
      tendon({attach("base", {0.02, 0.06, 0.2}), cylinder, attach("upper", {0.03, 0, -0.2}), drum,
              attach("lower", {0.01, 0.02, -0.2})}),
      bodies);
}

using Coordinates = Eigen::Matrix<double, 6, 1>;  // two rotation vectors

std::vector<BodyPose> poses(const Coordinates& q) {
  const auto turn = [](const Vec3& v) {
    return Eigen::AngleAxisd(v.norm(), v.norm() > 0 ? Vec3(v.normalized()) : Vec3::UnitX())
        .toRotationMatrix();
  };
  const BodyPose upper{turn(q.head<3>()), Vec3::Zero()};
  const BodyPose lower{upper.rotation * turn(q.tail<3>()), upper.rotation * Vec3(0, 0, -0.3)};
  return {{}, upper, lower};
}

}  // namespace

TEST_CASE(
    "over a quarter turn around a pulley the length is linear in the angle with moment arm r") {
  const Routing routing(
      tendon({attach("base", {-0.2, 0, 0.025}), pulley("base", {0, 0, 0}, 0.025, {0, 0, 1}),
              attach("upper", {0.2, 0, 0.025})}),
      bodies);
  const auto length = [&](double q) {
    std::vector<BodyPose> p(3);
    p[1].rotation = Eigen::AngleAxisd(q, Vec3::UnitY()).toRotationMatrix();
    return routing.solve(p).length_m;
  };
  for (double q = 0; q < 1.5; q += 0.1) CHECK(std::abs(length(q) - length(0) - 0.025 * q) < 1e-12);
}

TEST_CASE("the length rate agrees with central differences of the length") {
  const Routing routing = GENERATE(biarticular(), around_shafts());
  std::mt19937 random(7);
  std::uniform_real_distribution<double> angle(-0.5, 0.5);
  for (int trial = 0; trial < 50; ++trial) {
    Coordinates q, dq;
    for (int i = 0; i < 6; ++i) q[i] = angle(random), dq[i] = angle(random);
    const double h = 1e-5;
    const auto before = poses(q - h * dq), now = poses(q), after = poses(q + h * dq);
    std::vector<BodyTwist> twists(3);
    for (int k = 1; k < 3; ++k) {
      const Eigen::Matrix3d spin =
          (after[k].rotation - before[k].rotation) / (2 * h) * now[k].rotation.transpose();
      twists[k] = {{spin(2, 1), spin(0, 2), spin(1, 0)},
                   (after[k].position_m - before[k].position_m) / (2 * h)};
    }
    const double rate = length_rate_m_per_s(routing.solve(now), now, twists);
    const double difference =
        (routing.solve(after).length_m - routing.solve(before).length_m) / (2 * h);
    REQUIRE(std::abs(rate - difference) < 1e-8);
  }
}

TEST_CASE("the pulls on all bodies sum to zero, pulleys included") {
  const Routing routing = GENERATE(biarticular(), around_shafts());
  Coordinates q;
  q << 0.3, -0.4, 0.2, 0.1, 0.5, -0.3;
  const PathShape shape = routing.solve(poses(q));
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  int pulling = 0;
  for (const auto& pull : shape.pulled()) {
    force += pull.direction;
    moment += pull.at_m.cross(pull.direction) + pull.moment_m;
    pulling += pull.direction.norm() > 0;
  }
  CHECK(pulling >= 4);
  CHECK(force.norm() < 1e-13);
  CHECK(moment.norm() < 1e-13);
}

TEST_CASE("a path over two pulleys is the shortest path") {
  const Routing routing(
      tendon({attach("base", {0, 0.002, 0.2}), pulley("base", {0, 0, 0.05}, 0.03),
              pulley("base", {0.01, 0, -0.05}, 0.03), attach("base", {0, -0.002, -0.2})}),
      bodies);
  const std::vector<BodyPose> p(3);
  const PathShape shape = routing.solve(p);
  REQUIRE(shape.touches[1]);
  REQUIRE(shape.touches[2]);
  // All spans, the middle one included, are tangent to the spheres.
  for (int k : {1, 2}) {
    const Vec3 center = shape.pulls[k].at_m;
    const Vec3 before = shape.exit_m[k - 1] - shape.entry_m[k];
    const Vec3 after = shape.entry_m[k + 1] - shape.exit_m[k];
    CHECK(std::abs((shape.entry_m[k] - center).dot(before)) < 1e-12);
    CHECK(std::abs((shape.exit_m[k] - center).dot(after)) < 1e-12);
  }
}

TEST_CASE("turns around a shaft are counted over ±20 rad with moment arm r, up to lift-off") {
  const bool cylinder = GENERATE(true, false);
  const double r = 0.025, arm = 0.026;
  erp::Pulley shaft = pulley("upper", {0, 0, 0}, r);
  if (cylinder) shaft.shape = erp::PulleyShape::cylinder;
  shaft.axis = {0, 1, 0};
  shaft.turns = 4;
  const Routing routing(
      tendon({attach("base", {-0.2, 0, 0.025}), shaft, attach("upper", {0, 0, arm})}), bodies);
  std::vector<BodyPose> p(3);
  PathShape shape = routing.solve(p);
  const double start_m = shape.length_m;
  const auto turn_to = [&](double q) {
    p[1].rotation = Eigen::AngleAxisd(q, Vec3::UnitY()).toRotationMatrix();
    routing.solve(p, shape);
  };
  const auto is_linear_at = [&](double q) {
    turn_to(q);
    return std::abs(shape.length_m - start_m - r * q) < 1e-12;
  };
  for (double q = 0; q < 20; q += 0.1) REQUIRE(is_linear_at(q));
  for (double q = 20; q > -20; q -= 0.1) REQUIRE(is_linear_at(q));
  double before_m = shape.length_m;
  for (double q = -20; q > -28; q -= 0.1) {  // unwound: it lifts off without a jump
    turn_to(q);
    REQUIRE(std::abs(shape.length_m - before_m) < 0.1 * (arm + 1e-3));
    before_m = shape.length_m;
  }
  CHECK_FALSE(shape.touches[1]);
}

TEST_CASE("a line around a cylinder is straight on the unrolled surface") {
  const double r = 0.03, rise = 0.1;
  erp::Pulley cylinder = pulley("base", {0, 0, 0}, r);
  cylinder.shape = erp::PulleyShape::cylinder;
  cylinder.axis = {0, 0, 1};
  const Routing routing(
      tendon({attach("base", {0.1, 0, 0}), cylinder, attach("base", {-0.1, 0, rise})}), bodies);
  const PathShape shape = routing.solve(std::vector<BodyPose>(3));
  const double span_m = std::sqrt(0.1 * 0.1 - r * r);
  const double unrolled_m = 2 * span_m + r * (std::numbers::pi - 2 * std::acos(r / 0.1));
  REQUIRE(shape.touches[1]);
  CHECK(std::abs(shape.length_m - std::hypot(unrolled_m, rise)) < 1e-15);
  CHECK(shape.entry_m[1].y() > 0);  // right-handed about z
  const Vec3 in = (shape.entry_m[1] - shape.exit_m[0]).normalized();
  const Vec3 out = (shape.entry_m[2] - shape.exit_m[1]).normalized();
  CHECK(in.z() == Approx(rise / shape.length_m));
  CHECK(out.z() == Approx(in.z()));
}

TEST_CASE("robot.xml may have as many path elements as a routing") {
  CHECK(sim::max_path_elements == erp::robot_check::max_path_elements);
}

TEST_CASE("a path with both ends on one side of a shaft starts without a turn") {
  erp::Pulley shaft = pulley("base", {0, 0, 0}, 0.025);
  shaft.shape = erp::PulleyShape::cylinder;
  shaft.axis = {0, 1, 0};
  const Routing routing(
      tendon({attach("base", {0, -0.1, -0.05}), shaft, attach("base", {0, 0.1, -0.1})}), bodies);
  const PathShape shape = routing.solve(std::vector<BodyPose>(3));
  CHECK_FALSE(shape.touches[1]);
  CHECK(shape.length_m == Approx(std::hypot(0.2, 0.05)));
}

TEST_CASE("an invalid path is rejected") {
  CHECK_THROWS_AS(Routing(tendon({attach("base", {})}), bodies), std::invalid_argument);
  CHECK_THROWS_AS(Routing(tendon({attach("base", {}), pulley("base", {}, 0.01)}), bodies),
                  std::invalid_argument);
  CHECK_THROWS_AS(Routing(tendon({attach("base", {}), attach("nobody", {})}), bodies),
                  std::invalid_argument);
  CHECK_THROWS_AS(
      Routing(tendon({attach("base", {}), pulley("base", {}, 0), attach("base", {})}), bodies),
      std::invalid_argument);
}

TEST_CASE("a point inside a pulley in the starting pose is rejected") {
  const Routing routing(tendon({attach("base", {0, 0, 0.01}), pulley("base", {0, 0, 0}, 0.03),
                                attach("base", {0, 0, -0.2})}),
                        bodies);
  CHECK_THROWS_AS(routing.require_outside(std::vector<BodyPose>(3)), std::invalid_argument);
}

#include "sim/model/actuator/rope.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "sim/model/actuator/path_line.hpp"
#include "tests/sim/rigs.hpp"

using sim::BodyPose, sim::BodyTwist, sim::Rope, sim::Vec3;

namespace {

const std::vector<std::string> rope_bodies{"base", "other"};
constexpr double dt_s = 0.001;
const Vec3 down(0, 0, -9.81);

erp::Rope rope_of(int nodes, double friction = 0) {
  erp::Rope rope;
  rope.nodes = nodes, rope.mass_kg = 0.005, rope.friction = friction;
  return rope;
}

/// A rope between two points with rope_bodies at rest, initially straight or over its pulley.
struct HangingRope {
  sim::TendonLaw law;
  Rope rope;
  std::vector<BodyPose> poses{2};
  std::vector<BodyTwist> twists{2};

  HangingRope(const erp::Rope& type, std::vector<std::variant<erp::Attach, erp::Pulley>> path,
              double tension_N, std::vector<sim::Solid> solids = {})
      : HangingRope(type, tendon(std::move(path), tension_N), std::move(solids)) {}

  void settle(double time_s, const Vec3& gravity = Vec3::Zero(), double shaft_rad = 0) {
    for (double t = 0; t < time_s; t += dt_s) rope.step({poses, twists, gravity}, shaft_rad, dt_s);
  }

 private:
  static erp::Tendon tendon(std::vector<std::variant<erp::Attach, erp::Pulley>> path, double N) {
    erp::Tendon t = rigs::hinge_tendon();
    t.path = std::move(path), t.pretension_N = N;
    return t;
  }
  HangingRope(const erp::Rope& type, const erp::Tendon& t, std::vector<sim::Solid> solids)
      : HangingRope(type, t, sim::Routing(t, rope_bodies), std::move(solids)) {}
  HangingRope(const erp::Rope& type, const erp::Tendon& t, const sim::Routing& routing,
              std::vector<sim::Solid> solids)
      : law(sim::TendonLaw::at_rest(t, {{}, 0.0045}, routing.solve(poses_0()).length_m)),
        rope(type, law, routing, std::move(solids)) {
    const auto shape = routing.solve(poses_0());
    rope.lay(sim::path_line(routing, shape, 0.02), 0);
  }
  static std::vector<BodyPose> poses_0() { return std::vector<BodyPose>(2); }
};

erp::Attach rope_attachment(const std::string& body, xml::Vec3 at) { return {{}, body, at}; }

Vec3 sum_of_forces(const Rope& rope) {
  Vec3 sum = Vec3::Zero();
  for (const auto& force : rope.forces()) sum += force.force_N;
  return sum;
}

}  // namespace

TEST_CASE("the tension of a straight rope follows the tendon law, and increases with winding") {
  HangingRope h(rope_of(20),
                {rope_attachment("base", {0, 0, 0}), rope_attachment("other", {0.3, 0, 0})}, 30);
  h.settle(0.5);
  CHECK(h.rope.tension_N() == Approx(30).epsilon(1e-9));
  CHECK(h.rope.length_m() == Approx(0.3).epsilon(1e-9));
  h.settle(0.5, Vec3::Zero(), 1.0);
  CHECK(h.rope.tension_N() == Approx(30 + 6000 * 0.0045).epsilon(1e-6));
  CHECK(sum_of_forces(h.rope).norm() < 1e-6);
  CHECK(h.rope.failed_steps() == 0);
}

TEST_CASE("a slack rope hangs in a catenary and carries only its own weight") {
  HangingRope h(rope_of(40),
                {rope_attachment("base", {0, 0, 0}), rope_attachment("other", {0.3, 0, 0})}, 0);
  h.settle(10, down, -10);  // 45 mm of line unwound
  double lowest = 0;
  for (const Vec3& node : h.rope.nodes_m()) lowest = std::min(lowest, node.z());
  // The catenary: 2a sinh(d/2a) = L, sag a (cosh(d/2a) − 1).
  double a = 0.1;
  for (int k = 0; k < 100; ++k) {
    const double f = 2 * a * std::sinh(0.15 / a) - 0.345, h_a = 1e-7;
    a -= f * h_a / (2 * (a + h_a) * std::sinh(0.15 / (a + h_a)) - 0.345 - f);
  }
  CHECK(-lowest == Approx(a * (std::cosh(0.15 / a) - 1)).epsilon(0.01));
  CHECK(sum_of_forces(h.rope).z() == Approx(-0.005 * 9.81 * 39 / 40).epsilon(0.02));
}

TEST_CASE("a rope over a sphere has the length of the wrapped path and pushes on the sphere") {
  erp::Pulley pulley{{}, "base", {0.15, 0, -0.01}, 0.05};
  pulley.side = {0, 0, 1};
  const std::vector<std::variant<erp::Attach, erp::Pulley>> path{
      rope_attachment("base", {0, 0, 0}), pulley, rope_attachment("other", {0.3, 0, 0})};
  const int nodes = GENERATE(30, 60);
  HangingRope h(rope_of(nodes), path, 40);
  h.settle(2);
  erp::Tendon t = rigs::hinge_tendon();
  t.path = path;
  const double wrapped = sim::Routing(t, rope_bodies).solve(h.poses).length_m;
  const double step = 0.3 / nodes;  // error of a polygon on a circle: (step/r)² / 24 of the arc
  CHECK(h.rope.length_m() == Approx(wrapped).margin(0.08 * step * step / (0.05 * 0.05) / 6));
  CHECK(h.rope.tension_N() == Approx(40).epsilon(0.02));
  CHECK(sum_of_forces(h.rope).norm() < 0.02);
  REQUIRE(h.rope.forces().size() > 3);
  for (std::size_t k = 2; k < h.rope.forces().size(); ++k)
    CHECK(h.rope.forces()[k].force_N.z() < 0);
  CHECK(h.rope.failed_steps() == 0);
}

TEST_CASE("a rising capsule or box lifts the rope, which stays outside") {
  const sim::Solid capsule{1, {0.15, -0.2, -0.04}, {0.15, 0.2, -0.04}, 0.05};
  const sim::Solid box{1, {0.15, 0, -0.04}, {0.15, 0, -0.04}, 0, {0.02, 0.1, 0.05}};
  const sim::Solid solid = GENERATE_COPY(capsule, box);
  HangingRope h(rope_of(40),
                {rope_attachment("base", {0, 0, 0}), rope_attachment("base", {0.3, 0, 0})}, 20,
                {solid});
  h.twists[1].linear_m_per_s = Vec3(0, 0, 0.05);
  for (double z = -0.02; z < 0; z += 0.05 * dt_s)
    h.poses[1].position_m = Vec3(0, 0, z), h.settle(dt_s);
  h.twists[1] = {};
  h.settle(1);
  double highest = 0;
  for (const Vec3& node : h.rope.nodes_m()) {
    highest = std::max(highest, node.z());
    CHECK(sim::clearance(solid, node - h.poses[1].position_m).distance_m > -1e-8);
  }
  CHECK(highest == Approx(0.01).margin(1e-4));
  CHECK(sum_of_forces(h.rope).norm() < 0.05);
  CHECK(h.rope.failed_steps() == 0);
}

TEST_CASE("friction reduces the tension by e^(−µ φ) around a shaft") {
  const double friction = 0.3, r = 0.05;
  const sim::Solid shaft{0, {0.15, -0.2, -0.03}, {0.15, 0.2, -0.03}, r};
  HangingRope h(rope_of(80, friction),
                {rope_attachment("base", {0, 0, -0.15}), rope_attachment("other", {0.3, 0, -0.15})},
                5, {shaft});
  h.settle(1);
  for (int k = 0; k < 400; ++k) h.settle(dt_s, Vec3::Zero(), 0.01 * k);  // pulled over the shaft
  const auto& tension = h.rope.state().tension_N;
  const double phi =
      std::acos((h.rope.nodes_m()[1] - h.rope.nodes_m()[0])
                    .normalized()
                    .dot((h.rope.nodes_m()[80] - h.rope.nodes_m()[79]).normalized()));
  CHECK(tension.front() / tension.back() == Approx(std::exp(friction * phi)).epsilon(0.05));
}

TEST_CASE("the watchdog counts a step in which the rope diverges and resets the rope") {
  HangingRope h(rope_of(20),
                {rope_attachment("base", {0, 0, 0}), rope_attachment("other", {0.3, 0, 0})}, 30);
  h.poses[1].position_m = Vec3(0, 0, 500);  // in one millisecond
  h.settle(dt_s);
  CHECK(h.rope.failed_steps() == 1);
  CHECK(h.rope.nodes_m()[10].allFinite());
}

#include "sim/model/actuator/pulley_wrap.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

using sim::Wrap, sim::Vec3, sim::wrap_sphere;

namespace {

constexpr double r = 0.03, a = 0.11, b = 0.07;
const double lift_off = std::acos(r / a) + std::acos(r / b);
const Eigen::Matrix3d tilt =
    Eigen::AngleAxisd(0.7, Vec3(0.3, -0.5, 0.8).normalized()).toRotationMatrix();

/// End points at distances a and b with an angle between them, in a tilted plane.
Wrap at_angle(double angle, const Vec3& side = Vec3::Zero()) {
  const Vec3 from = a * Vec3::UnitX(), to = b * Vec3(std::cos(angle), std::sin(angle), 0);
  return wrap_sphere(tilt * from, tilt * to, r, tilt * side);
}

double wrapped_length(double angle) {
  return std::sqrt(a * a - r * r) + std::sqrt(b * b - r * r) + r * (angle - lift_off);
}

}  // namespace

TEST_CASE("the wrapped length is exact to 1e-12 m") {
  for (double angle = lift_off + 1e-6; angle < std::numbers::pi; angle += 1e-3)
    REQUIRE(std::abs(at_angle(angle).length_m - wrapped_length(angle)) < 1e-12);
}

TEST_CASE("without contact the line is straight") {
  for (double angle = 1e-3; angle < lift_off; angle += 1e-3) {
    const Wrap wrap = at_angle(angle);
    REQUIRE_FALSE(wrap.touches);
    REQUIRE(std::abs(wrap.length_m - std::sqrt(a * a + b * b - 2 * a * b * std::cos(angle))) <
            1e-12);
  }
}

TEST_CASE("the length and its derivative are continuous at lift-off") {
  const double h = 1e-6;
  const auto slope = [&](double x) {
    return (at_angle(x + h).length_m - at_angle(x - h).length_m) / (2 * h);
  };
  CHECK(at_angle(lift_off + 1e-9).length_m - at_angle(lift_off - 1e-9).length_m ==
        Approx(2e-9 * r).margin(1e-14));
  CHECK(slope(lift_off + 2 * h) == Approx(slope(lift_off - 2 * h)).margin(1e-6));
}

TEST_CASE("both spans are tangent to the sphere") {
  for (double angle : {lift_off + 1e-4, 2.7, 3.0, 3.1415}) {
    const Wrap wrap = at_angle(angle);
    const Vec3 from = tilt * (a * Vec3::UnitX());
    const Vec3 to = tilt * (b * Vec3(std::cos(angle), std::sin(angle), 0));
    CHECK(wrap.entry_m.norm() == Approx(r).epsilon(1e-13));
    CHECK(wrap.exit_m.norm() == Approx(r).epsilon(1e-13));
    CHECK(std::abs(wrap.entry_m.dot(from - wrap.entry_m)) < 1e-14);
    CHECK(std::abs(wrap.exit_m.dot(to - wrap.exit_m)) < 1e-14);
  }
}

TEST_CASE("the length is exact near and at opposite ends (φ = π)") {
  for (double gap : {1e-3, 1e-6, 1e-9, 1e-12, 0.0})
    CHECK(std::abs(at_angle(std::numbers::pi - gap).length_m -
                   wrapped_length(std::numbers::pi - gap)) < 1e-12);
}

TEST_CASE("with exactly opposite ends the line wraps in any plane, or on the given side") {
  const auto across = [](const Vec3& side) { return wrap_sphere({0, 0, a}, {0, 0, -b}, r, side); };
  CHECK(std::abs(across(Vec3::Zero()).length_m - wrapped_length(std::numbers::pi)) < 1e-12);
  CHECK(across(Vec3::Zero()).entry_m.norm() == Approx(r).epsilon(1e-13));
  CHECK(across({0, 1, 0}).entry_m.y() > 0);
  CHECK(across({0, -1, 0}).entry_m.y() < 0);
}

TEST_CASE("with a side the line stays on that side beyond φ = π") {
  const Vec3 side = Vec3::UnitY();
  for (double angle = lift_off + 1e-3; angle < 2 * std::numbers::pi - 1e-3; angle += 1e-3)
    REQUIRE(std::abs(at_angle(angle, side).length_m - wrapped_length(angle)) < 1e-12);
  CHECK(std::abs(at_angle(std::numbers::pi, side).length_m - wrapped_length(std::numbers::pi)) <
        1e-12);
}

TEST_CASE("the opposite side gives the opposite direction of wrapping") {
  const double angle = 2.5;
  CHECK(at_angle(angle, Vec3(0, -1, 0)).wrapped_rad ==
        Approx(2 * std::numbers::pi - angle - lift_off).epsilon(1e-12));
}

TEST_CASE("an end inside the sphere is reported") {
  CHECK(wrap_sphere({0.02, 0, 0}, {-0.1, 0, 0}, r, Vec3::Zero()).inside);
  CHECK(wrap_sphere({-0.1, 0, 0}, {0, 0.02, 0}, r, Vec3::Zero()).inside);
  CHECK_FALSE(wrap_sphere({r, 0, 0}, {-0.1, 0, 0}, r, Vec3::Zero()).inside);
}

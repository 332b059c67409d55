#include "sim/gap/estimation/far_off.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

using namespace sim::estimation;

namespace {

/// Two constants with nominal value 1, tolerance 0.02 and lower bound 0.05.
Uncertain two_factors() {
  Uncertain u;
  for (const char* type : {"routing_moment_arm", "spindle_radius"}) {
    Constant c{};
    c.name = type, c.on = "flexor", c.effect = type;
    c.nominal = 1, c.tolerance = 0.02, c.lowest = 0.05;
    u.constants.push_back(c);
  }
  return u;
}

/// Each of these constants twice.
Uncertain four_factors() {
  Uncertain u = two_factors();
  u.constants.insert(u.constants.end(), u.constants.begin(), u.constants.begin() + 2);
  return u;
}

/// A measurement of x with standard deviation 1.
struct Row {
  double first_sensitivity, second_sensitivity, measured;
};

Estimate at_nominal(const std::vector<Row>& rows) {
  Estimate e;
  e.point.x = {0, 0};
  e.z.resize(Eigen::Index(rows.size())), e.weight = Eigen::VectorXd::Ones(e.z.size());
  e.jacobian.resize(e.z.size(), 2);
  for (std::size_t n = 0; n < rows.size(); ++n) {
    e.z[Eigen::Index(n)] = -rows[n].measured;
    e.jacobian.insert(Eigen::Index(n), 0) = rows[n].first_sensitivity;
    e.jacobian.insert(Eigen::Index(n), 1) = rows[n].second_sensitivity;
  }
  return e;
}

}  // namespace

TEST_CASE(
    "if a ratio of two constants is 6 tolerances off, one is reported and the other one is its "
    "alternative") {
  const FarOff found = far_off(two_factors(), at_nominal({{20, -20, 20 * 6}}));
  REQUIRE(found.all.size() == 1);  // not both, with three tolerances each
  CHECK(std::abs(found.all[0].x) == Approx(6).epsilon(0.1));
  REQUIRE(found.alternatives[0].size() == 1);
  CHECK(found.alternatives[0][0].constant == 1 - found.all[0].constant);
  CHECK(found.alternatives[0][0].x == Approx(-found.all[0].x));
}

TEST_CASE("a separate measurement of one of two constants leaves no alternative") {
  const FarOff found = far_off(two_factors(), at_nominal({{20, -20, 20 * 6}, {2, 0, 2 * 6}}));
  REQUIRE(found.all.size() == 1);
  CHECK(found.all[0].constant == 0);
  CHECK(found.alternatives[0].empty());
}

TEST_CASE(
    "a constant that deviates by 2 tolerances, is hardly determined or is below its lower bound is "
    "not far off") {
  CHECK(far_off(two_factors(), at_nominal({{20, 0, 20 * 2}})).all.empty());
  CHECK(far_off(two_factors(), at_nominal({{0.3, 0, 0.3 * 6}})).all.empty());
  CHECK(far_off(two_factors(), at_nominal({{20, 0, 20 * -60}})).all.empty());
  CHECK(far_off(two_factors(), at_nominal({{20, 0, 20 * -40}})).all.size() == 1);
}

TEST_CASE("a constant is removed if constants that were added after it explain the same") {
  Eigen::Matrix4d rows;
  rows << -2, 1, 1, 2, -2, 2, 2, 0, 1, 0, 2, 1, 0, -1, -1, 2;
  rows *= 20;
  Estimate e;
  e.point.x = {0, 0, 0, 0};
  e.z = -rows * Eigen::Vector4d(0, -6, 6, -7), e.weight = Eigen::Vector4d::Ones();
  e.jacobian = rows.sparseView();
  const FarOff found = far_off(four_factors(), e);
  REQUIRE(found.all.size() == 2);
  for (const Deviation& d : found.all) CHECK(d.constant < 2);
}

TEST_CASE("a constant may be far off above 1.9 tolerances, a zero above 4.4 tolerances") {
  Constant c{};
  CHECK_FALSE(is_worth_far(c, -1.8));
  CHECK(is_worth_far(c, -1.95));
  c.zero = true;
  CHECK_FALSE(is_worth_far(c, 4.3));
  CHECK(is_worth_far(c, 4.45));
}

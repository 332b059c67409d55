#include "sim/world/joint_rows.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using sim::JointFriction, sim::JointLimit, sim::JointRows;

namespace {

/// W of a ball joint and a hinge, coupled as in an arm.
MatrixXd coupled() {
  MatrixXd m(4, 4);
  m << 0.09, 0.01, 0.00, 0.02, 0.01, 0.08, 0.005, 0.03, 0.00, 0.005, 0.01, 0.001, 0.02, 0.03, 0.001,
      0.04;
  return m.inverse();
}

VectorXd speeds(double a, double b, double c, double d) {
  VectorXd v(4);
  v << a, b, c, d;
  return v;
}

const std::vector<JointFriction> frictions{{0, 3, 0.1, 0.05}, {3, 1, 0.05, 0.03}};
constexpr double dt = 1e-3;

}  // namespace

TEST_CASE("each friction impulse is the law at the velocity it leaves") {
  const MatrixXd w = coupled();
  JointRows rows(frictions, 4);
  VectorXd v = speeds(1, -2, 0.5, 3);
  const VectorXd before = v;
  rows.solve(w, {}, dt, v);
  const VectorXd impulse = w.inverse() * (v - before);
  const Vector3d ball = v.head<3>();
  CHECK((impulse.head<3>() + dt * (0.1 * ball + 0.05 * ball.normalized())).norm() < 1e-12);
  CHECK(impulse[3] == Approx(-dt * (0.05 * v[3] + 0.03)).epsilon(1e-9));
}

TEST_CASE("slow joints are stopped within their bounds, and no more than stopped") {
  const MatrixXd w = coupled();
  JointRows rows(frictions, 4);
  VectorXd v = w * speeds(2e-5, -2e-5, 1e-5, 2e-5);  // impulses well within τ_c dt
  const VectorXd before = v;
  rows.solve(w, {}, dt, v);
  CHECK(v.norm() < 1e-12);
  CHECK((w.inverse() * (v - before)).head<3>().norm() <= 0.05 * dt);
}

TEST_CASE("a joint may stick while its neighbour slides") {
  const MatrixXd w = coupled();
  JointRows rows(frictions, 4);
  VectorXd v = w * speeds(0, 0, 0, 8e-5);  // the shoulder has to hold 4.5e-5 of it
  rows.solve(w, {}, dt, v);
  CHECK(v.head<3>().norm() < 1e-12);
  CHECK(v[3] > 1e-4);
}

TEST_CASE("a limit only pushes back, and only as far as it must") {
  const MatrixXd w = coupled();
  JointRows rows({}, 4);
  const std::vector<JointLimit> limits{{3, 1, Vector3d::UnitX(), 0.001}};
  VectorXd fast = speeds(0, 0, 0, 5), slow = speeds(0, 0, 0, 0.5);
  rows.solve(w, limits, dt, fast);
  rows.solve(w, limits, dt, slow);
  CHECK(fast[3] == Approx(1.0));  // gap / dt
  CHECK(slow[3] == 0.5);
}

TEST_CASE("the coupled problem is solved in few sweeps, and at once when it comes again") {
  const MatrixXd w = coupled();
  JointRows rows(frictions, 4);
  VectorXd v = speeds(0.001, -0.001, 0.001, 0.001), again = v;
  CHECK(rows.solve(w, {}, dt, v) < 100);
  CHECK(rows.solve(w, {}, dt, again) <= 3);
}

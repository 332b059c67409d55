#include <Eigen/Geometry>
#include <numbers>
#include <random>

#include "tests/bench/accuracy/figure.hpp"
#include "tests/bench/accuracy/muscles.hpp"
#include "tests/sim/skeletons.hpp"

namespace accuracy {
namespace {

using sim::JointReading, sim::Vec3;
using Joints = std::vector<JointReading>;

/// A random state of configs/arm within its joint limits: shoulder, coordinates 0 to 2, and elbow,
/// coordinate 3; speeds up to 2 rad/s about each axis, chosen.
Joints random_state(std::mt19937& random) {
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const Vec3 axis = Vec3::NullaryExpr([&] { return between(-1, 1); }).normalized();
  const Eigen::Quaterniond q(Eigen::AngleAxisd(between(0, 2.2), axis));
  JointReading shoulder{erp::JointType::spherical, {q.w(), q.x(), q.y(), q.z()}, {}, {}, {}};
  JointReading elbow{erp::JointType::revolute, {between(-0.05, 2.4)}, {}, {}, {}};
  for (double& speed : shoulder.velocity_rad_per_s) speed = between(-2, 2);
  elbow.velocity_rad_per_s[0] = between(-2, 2);
  return {shoulder, elbow};
}

/// Returns the state with coordinate d changed by `change_rad`.
Joints with_changed_coordinate(Joints joints, int d, double change_rad) {
  if (d == 3) return joints[1].position[0] += change_rad, joints;
  auto& p = joints[0].position;
  const Eigen::Quaterniond q = Eigen::Quaterniond(p[0], p[1], p[2], p[3]) *
                               Eigen::Quaterniond(Eigen::AngleAxisd(change_rad, Vec3::Unit(d)));
  p = {q.w(), q.x(), q.y(), q.z()};
  return joints;
}

// ∂L/∂q_d = (L(q + h e_d) − L(q − h e_d)) / 2h + O(h²)
double gradient_error_m(Muscles& arm, const Joints& joints, std::size_t k) {
  const double h = 1e-6;
  const Eigen::VectorXd row = arm.gradient(k);
  double worst = 0;
  for (int d = 0; d < row.size(); ++d) {
    arm.model.place(with_changed_coordinate(joints, d, h));
    const double length_above_m = arm.path(k).length_m;
    arm.model.place(with_changed_coordinate(joints, d, -h));
    const double length_below_m = arm.path(k).length_m;
    worst = larger(worst, std::abs(row[d] - (length_above_m - length_below_m) / (2 * h)));
  }
  arm.model.place(joints);
  return worst;
}

}  // namespace

Figures quarter_turn() {
  const double r_m = 0.025, span_m = 0.2;  // chosen
  Muscles lever(rigs::robot({rigs::root(), rigs::bone("lever", 1, {}, {1, 1, 1})},
                            {rigs::joint("hinge", erp::JointType::revolute, "base", "lever")}));
  erp::Tendon tendon = rigs::hinge_tendon();
  tendon.path = {erp::Attach{{}, "base", {-span_m, 0, r_m}},
                 erp::Pulley{{}, "base", {0, 0, 0}, r_m, {0, 0, 1}},
                 erp::Attach{{}, "lever", {span_m, 0, r_m}}};
  lever.add(tendon);
  double moment_arm_error_m = 0, path_length_error_m = 0;
  for (double q = 0; q <= std::numbers::pi / 2; q += 0.01) {
    lever.model.place(Joints{{erp::JointType::revolute, {q}, {}, {}, {}}});
    // dL/dq = r, L = 2 s + r q
    moment_arm_error_m = larger(moment_arm_error_m, std::abs(lever.gradient(0)[0] - r_m));
    path_length_error_m =
        larger(path_length_error_m, std::abs(lever.path(0).length_m - 2 * span_m - r_m * q));
  }
  return {{2, "moment arm of a pulley over a quarter turn", moment_arm_error_m, 1e-12, "m"},
          {2, "path length over that pulley, against a linear function of the angle",
           path_length_error_m, 1e-12, "m"}};
}

Figures muscle_jacobian() {
  Muscles arm(erp::read_robot(rigs::config("arm/robot.xml")));
  std::mt19937 random(3);
  double gradient_m = 0, power_W = 0, force_N = 0, moment_Nm = 0;
  for (int pose = 0; pose < 200; ++pose) {
    const Joints joints = random_state(random);
    arm.model.place(joints);
    for (std::size_t k = 0; k < arm.count(); ++k) {
      const Sums muscle_sums = arm.sums(k);
      // Σ power = −F dL/dt, Σ force = 0, Σ moment = 0
      const double rate_m_per_s = arm.gradient(k).dot(arm.model.velocity());
      power_W = larger(power_W, std::abs(muscle_sums.power_W + rate_m_per_s));
      force_N = larger(force_N, muscle_sums.force_N.norm());
      moment_Nm = larger(moment_Nm, muscle_sums.moment_Nm.norm());
      gradient_m = larger(gradient_m, gradient_error_m(arm, joints, k));
    }
  }
  return {{3, "∂L/∂q of the arm's muscles in 200 poses, against central differences", gradient_m,
           1e-8, "m/rad"},
          {3, "power of a muscle's forces + F dL/dt, for 1 N", power_W, 1e-12, "W"},
          {3, "sum of a muscle's forces, including pulleys, for 1 N", force_N, 1e-13, "N"},
          {3, "sum of the moments of these forces, for 1 N", moment_Nm, 1e-13, "Nm"}};
}

}  // namespace accuracy

// Measures the duration of a cycle of the joint controllers, and compares the tension distribution
// with CGAL's solver of quadratic programs.
#include <CGAL/MP_Float.h>
#include <CGAL/QP_functions.h>
#include <CGAL/QP_models.h>

#include <algorithm>
#include <cstdio>
#include <random>

#include "components/computed_force/computed_force.hpp"
#include "components/pose_estimator/pose_estimator.hpp"
#include "tests/bench/times.hpp"

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

using bench::Durations;

/// A robot with joint references that oscillate about the initial pose.
struct Oscillation {
  erp::Robot robot;
  joints::Names names;
  std::vector<sim::JointMotion> motions;
  node::Latest<erp::JointState> state;
  node::Latest<erp::JointTarget> target;
  erp::SensorFrame frame;

  explicit Oscillation(const std::string& name)
      : robot(erp::read_robot(ERP_SOURCE_DIR "/configs/" + name + "/robot.xml")), names(robot) {
    for (const auto& actuator : robot.actuators) {
      erp::ActuatorSample sample{};
      erp::assign(sample.name, actuator.name);
      sample.valid = erp::valid::all, sample.tension_N = actuator.tendon.pretension_N;
      erp::append(frame.actuators, sample);
    }
    state.received = target.received = true;
  }
  void move_to(double time_s) {
    const double s = std::sin(3 * time_s), c = 3 * std::cos(3 * time_s);
    motions.clear();
    for (const auto& joint : names.list()) {
      sim::JointMotion motion{sim::initial_reading(joint), {}};
      motion.now.position = sim::displaced(joint.type, motion.now.position, {0.1 * s, 0.1 * s, 0});
      motion.now.velocity_rad_per_s = {0.1 * c, 0.1 * c, 0};
      motion.acceleration_rad_per_s2 = {-0.9 * s, -0.9 * s, 0};
      motions.push_back(motion);
    }
    names.write(motions, target.message);
    state.message.joints._length = 0;
    for (const auto& desired : erp::samples(target.message.joints)) {
      erp::JointStateSample actual{};
      erp::assign(actual.name, desired.name);
      std::ranges::copy(desired.position, actual.position);
      std::ranges::copy(desired.velocity_rad_per_s, actual.velocity_rad_per_s);
      erp::append(state.message.joints, actual);
    }
  }
};

void cycle_row(const std::string& name) {
  Oscillation oscillation(name);
  control::ComputedForce control({}, oscillation.robot);
  pose::PoseEstimator estimator({}, oscillation.robot);
  sim::Musculoskeletal model(oscillation.robot);
  Durations control_durations, estimator_durations;
  for (int k = 0; k < 5000; ++k) {
    oscillation.move_to(0.002 * k);
    control_durations.measure([&] {
      (void)control.step(oscillation.frame, 0.002, oscillation.state, oscillation.target);
    });
    estimator_durations.measure([&] { (void)estimator.step(oscillation.frame, 0.002, {}, {}); });
  }
  std::printf("| %-9s | %2zu | %3d | %7.1f | %7.1f | %7.1f | %7.1f |\n", name.c_str(),
              oscillation.robot.actuators.size(), model.coordinates(),
              control_durations.quantile_us(0.5), control_durations.quantile_us(0.99),
              estimator_durations.quantile_us(0.5), estimator_durations.quantile_us(0.99));
}

// ---- the quadratic program ----

struct Program {
  MatrixXd jacobian;
  VectorXd torque;
};

/// Quadratic programs with torques near those that compensate gravity.
std::vector<Program> programs(const erp::Robot& robot, int count) {
  sim::Musculoskeletal model(robot);
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  std::vector<Program> programs_to_solve;
  VectorXd torque;
  model.skeleton().gravity_torques(torque);
  for (int k = 0; k < count; ++k) {
    torque += 0.05 * VectorXd::NullaryExpr(torque.size(), [&] { return normal(random); });
    programs_to_solve.push_back({model.jacobian(), torque});
  }
  return programs_to_solve;
}

/// Solves a program with CGAL:  min ½ fᵀ f − f°ᵀ f  with  Lᵀ f = −τ,  low ≤ f ≤ high.
/// Returns NaN if it is infeasible.
VectorXd solve_with_cgal(const Program& program, const sim::ObjectiveTerms& terms) {
  CGAL::Quadratic_program<double> qp(CGAL::EQUAL, true, 0, true, 0);
  const int n = static_cast<int>(program.jacobian.rows()),
            m = static_cast<int>(program.jacobian.cols());
  for (int a = 0; a < n; ++a) {
    qp.set_l(a, true, terms.low_N[a]), qp.set_u(a, true, terms.high_N[a]);
    qp.set_d(a, a, 1), qp.set_c(a, -terms.preferred_N[a]);
    for (int d = 0; d < m; ++d) qp.set_a(a, d, program.jacobian(a, d));
  }
  for (int d = 0; d < m; ++d) qp.set_b(d, -program.torque[d]);
  const auto solution = CGAL::solve_quadratic_program(qp, CGAL::MP_Float());
  VectorXd tension_N = VectorXd::Constant(n, std::nan(""));
  if (solution.is_infeasible()) return tension_N;
  int a = 0;
  for (auto value = solution.variable_values_begin(); value != solution.variable_values_end();
       ++value)
    tension_N[a++] = CGAL::to_double(*value);
  return tension_N;
}

void program_row(const std::string& name) {
  const erp::Robot robot = erp::read_robot(ERP_SOURCE_DIR "/configs/" + name + "/robot.xml");
  const sim::ObjectiveTerms terms =
      sim::objective_terms(robot, sim::TensionObjective::least_tension, 5);
  const auto programs_to_solve = programs(robot, 20);
  sim::TensionDistribution distribution(terms, static_cast<int>(programs_to_solve[0].jacobian.cols()));
  Durations erp_durations, cgal_durations;
  double difference_N = 0;
  int solved = 0;
  for (const Program& program : programs_to_solve) {
    VectorXd tension_N, cgal_tension_N;
    erp_durations.measure(
        [&] { tension_N = distribution.distribute(program.jacobian, program.torque); });
    cgal_durations.measure([&] { cgal_tension_N = solve_with_cgal(program, terms); });
    if (cgal_tension_N.hasNaN()) continue;
    ++solved;
    difference_N = std::max(difference_N, (tension_N - cgal_tension_N).cwiseAbs().maxCoeff());
  }
  std::printf("| %-9s | %7.1f | %9.1f | %5.0f | %2d of %zu | %.1e |\n", name.c_str(),
              erp_durations.quantile_us(0.5), cgal_durations.quantile_us(0.5),
              cgal_durations.quantile_us(0.5) / erp_durations.quantile_us(0.5), solved,
              programs_to_solve.size(), difference_N);
}

}  // namespace

int main() {
  std::puts(
      "| robot | muscles | coordinates | computed force, µs p50 | p99 | estimator, p50 | p99 |");
  for (const char* name : {"hinge_rig", "arm", "seven_dof", "ecce4"}) cycle_row(name);
  std::puts(
      "\n| robot | tension distribution, µs | CGAL, µs | ratio | solved by both | difference, N |");
  for (const char* name : {"hinge_rig", "arm", "seven_dof"}) program_row(name);
}

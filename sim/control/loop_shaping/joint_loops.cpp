#include "sim/control/loop_shaping/joint_loops.hpp"

#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>

namespace sim::loop_shaping {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;

namespace {

constexpr double to_rad_per_s = 2 * std::numbers::pi;

StateSpace repeated(const StateSpace& system, Index times) {
  return side_by_side(std::vector<StateSpace>(static_cast<std::size_t>(times), system));
}

/// From joint torques to joint angles.
StateSpace bones(Musculoskeletal& model) {
  const auto hinges = hinges_of(model);
  const auto n = static_cast<Index>(hinges.size());
  MatrixXd h(n, n);
  model.skeleton().inertia(h);
  const MatrixXd inverse = h.inverse();
  StateSpace g{MatrixXd::Zero(2 * n, 2 * n), MatrixXd::Zero(2 * n, n), MatrixXd::Zero(n, 2 * n),
               MatrixXd::Zero(n, n)};
  for (const Hinge& hinge : hinges)
    g.a.col(hinge.coordinate).head(n) = -inverse.col(hinge.coordinate) * hinge.viscous_Nm_s_per_rad;
  g.a.bottomLeftCorner(n, n).setIdentity();
  g.b.topRows(n) = inverse;
  g.c.rightCols(n).setIdentity();
  return g;
}

/// Actuator dynamics: from commanded to actual torque.
StateSpace torque_dynamics(const JointShape& shape) {
  const double lag = 1 / shape.smooth_s, pade = 2 / shape.delay_s;
  const StateSpace lag_filter = first_order(0, lag, lag);
  return in_series(in_series(first_order(-1, pade, pade), lag_filter), lag_filter);
}

/// k (s + ω_i)/s · (s + z)/(s + α ω_c), for a corner of friction µ/h
StateSpace one_weight(const JointShape& shape, double friction_per_s) {
  const double wc = to_rad_per_s * shape.crossover_Hz, wi = to_rad_per_s * shape.integral_Hz;
  const double zero = std::max(wc / shape.lead, friction_per_s);
  const StateSpace unscaled =
      in_series(first_order(1, wi, 0), first_order(1, zero, wc * shape.lead));
  const double plant_gain = std::abs(response(torque_dynamics(shape), wc)(0, 0)) / (wc * wc);
  const double k = 1 / (std::abs(response(unscaled, wc)(0, 0)) * plant_gain);
  return in_series(unscaled, constant(MatrixXd::Constant(1, 1, k)));
}

}  // namespace

std::vector<Hinge> hinges_of(const Musculoskeletal& model) {
  std::vector<Hinge> hinges;
  const auto& joints = model.tree().joints;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const int first = model.skeleton().first_of(static_cast<int>(j));
    if (first < 0) continue;
    if (joints[j].type != erp::JointType::revolute)
      throw std::invalid_argument(
          "joint \"" + joints[j].name +
          "\" is not a hinge: puller-follower control supports only revolute joints");
    hinges.push_back({joints[j].name, static_cast<int>(j), first, joints[j].viscous_Nm_s_per_rad,
                      joints[j].coulomb_Nm});
  }
  return hinges;
}

StateSpace hinge_plant(Musculoskeletal& model, const JointShape& shape) {
  return in_series(repeated(torque_dynamics(shape), model.coordinates()), bones(model));
}

void align(const MatrixXd& inertia, std::span<const Hinge> hinges, const JointShape& shape,
           MatrixXd& alignment) {
  const double wc = to_rad_per_s * shape.crossover_Hz;
  alignment = inertia;
  for (const Hinge& hinge : hinges) {
    double& h = alignment(hinge.coordinate, hinge.coordinate);
    h = std::hypot(h, hinge.viscous_Nm_s_per_rad / wc);
  }
}

namespace {

MatrixXd alignment_of(Musculoskeletal& model, const JointShape& shape) {
  const Index n = model.coordinates();
  MatrixXd inertia(n, n), alignment(n, n);
  model.skeleton().inertia(inertia);
  align(inertia, hinges_of(model), shape, alignment);
  return alignment;
}

}  // namespace

JointLoops joint_loops(Musculoskeletal& model, const JointShape& shape) {
  MatrixXd inertia(model.coordinates(), model.coordinates());
  model.skeleton().inertia(inertia);
  std::vector<StateSpace> weights(static_cast<std::size_t>(model.coordinates()));
  for (const Hinge& hinge : hinges_of(model)) {
    const int at = hinge.coordinate;
    weights[static_cast<std::size_t>(at)] =
        one_weight(shape, hinge.viscous_Nm_s_per_rad / inertia(at, at));
  }
  JointLoops loops{
      hinge_plant(model, shape), side_by_side(weights), alignment_of(model, shape), {}};
  loops.robust = stabilised(in_series(loops.weight(), loops.plant));
  return loops;
}

MatrixXd JointLoops::holding() const {
  const Index first = robust.controller.states(), n = shape.states(), m = shape.outputs();
  MatrixXd equations(n + m, n), unit_outputs = MatrixXd::Zero(n + m, m);
  equations << shape.a, shape.c;
  unit_outputs.bottomRows(m).setIdentity();
  MatrixXd states = MatrixXd::Zero(first + n, m);
  states.bottomRows(n) = equations.completeOrthogonalDecomposition().solve(unit_outputs);
  return states;
}

JointLoops moved(const JointLoops& loops, Musculoskeletal& model, const JointShape& shape) {
  return {hinge_plant(model, shape), loops.shape, alignment_of(model, shape), loops.robust};
}

namespace {

/// Highest frequency at which the loop gain of joint `j` is 1, Hz.
double crossover_Hz(const std::vector<MatrixXcd>& inverse_closed, const std::vector<double>& w,
                    Index j) {
  double highest_Hz = 0;
  for (std::size_t k = 0; k < w.size(); ++k) {
    const std::complex<double> loop = 1.0 / inverse_closed[k](j, j) - 1.0;  // S_jj = 1/(1 + L_j)
    if (std::abs(loop) >= 1) highest_Hz = w[k] / to_rad_per_s;
  }
  return highest_Hz;
}

}  // namespace

LoopCheck checked(const JointLoops& loops) {
  const StateSpace& plant = loops.plant;
  constexpr double low_rad_per_s = 0.01, high_rad_per_s = 1000;
  constexpr int count = 400;
  const StateSpace controller = loops.controller();
  std::vector<double> w;
  std::vector<MatrixXcd> sensitivity;
  const Index n = plant.outputs();
  LoopCheck check{margin_of(in_series(loops.weight(), plant), loops.robust.controller,
                            low_rad_per_s, high_rad_per_s),
                  slowest_pole_per_s(closed(plant, controller)),
                  0,
                  {}};
  for (int k = 0; k < count; ++k) {
    w.push_back(low_rad_per_s * std::pow(high_rad_per_s / low_rad_per_s, k / (count - 1.0)));
    const MatrixXcd loop = response(plant, w.back()) * response(controller, w.back());
    sensitivity.push_back((MatrixXcd::Identity(n, n) + loop).inverse());
    check.max_sensitivity = std::max(
        check.max_sensitivity, Eigen::JacobiSVD<MatrixXcd>(sensitivity.back()).singularValues()[0]);
  }
  for (Index j = 0; j < n; ++j) check.crossover_Hz.push_back(crossover_Hz(sensitivity, w, j));
  return check;
}

}  // namespace sim::loop_shaping

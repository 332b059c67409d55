#include "sim/control/loop_shaping/state_space.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <complex>

namespace sim::loop_shaping {

using Eigen::Index;
using Eigen::MatrixXd;

StateSpace constant(const MatrixXd& gain) {
  return {MatrixXd(0, 0), MatrixXd(0, gain.cols()), MatrixXd(gain.rows(), 0), gain};
}

StateSpace first_order(double k1, double k0, double pole_per_s) {
  const auto one = [](double value) { return MatrixXd::Constant(1, 1, value); };
  return {one(-pole_per_s), one(1), one(k0 - k1 * pole_per_s), one(k1)};
}

StateSpace in_series(const StateSpace& first, const StateSpace& then) {
  const Index m = first.states(), n = then.states();
  StateSpace both;
  both.a = MatrixXd::Zero(m + n, m + n);
  both.a.topLeftCorner(m, m) = first.a;
  both.a.bottomLeftCorner(n, m) = then.b * first.c;
  both.a.bottomRightCorner(n, n) = then.a;
  both.b = MatrixXd(m + n, first.inputs());
  both.b << first.b, then.b * first.d;
  both.c = MatrixXd(then.outputs(), m + n);
  both.c << then.d * first.c, then.c;
  both.d = then.d * first.d;
  return both;
}

namespace {

/// Appends a block to a block-diagonal matrix.
void append(MatrixXd& blocks, const MatrixXd& block) {
  const Index r = blocks.rows(), c = blocks.cols();
  blocks.conservativeResizeLike(MatrixXd::Zero(r + block.rows(), c + block.cols()));
  blocks.bottomRightCorner(block.rows(), block.cols()) = block;
}

}  // namespace

StateSpace side_by_side(std::span<const StateSpace> systems) {
  StateSpace all;
  for (const StateSpace& one : systems)
    append(all.a, one.a), append(all.b, one.b), append(all.c, one.c), append(all.d, one.d);
  return all;
}

Eigen::MatrixXcd response(const StateSpace& system, double rad_per_s) {
  const std::complex<double> s(0, rad_per_s);
  const Eigen::MatrixXcd m = s * Eigen::MatrixXcd::Identity(system.states(), system.states()) -
                             system.a.cast<std::complex<double>>();
  return system.c * m.partialPivLu().solve(system.b.cast<std::complex<double>>()) + system.d;
}

double slowest_pole_per_s(const StateSpace& system) {
  if (system.states() == 0) return -INFINITY;
  return Eigen::EigenSolver<MatrixXd>(system.a, false).eigenvalues().real().maxCoeff();
}

StateSpace closed(const StateSpace& plant, const StateSpace& controller) {
  StateSpace loop = in_series(controller, plant);
  loop.a -= loop.b * loop.c;
  return loop;
}

// s = 2/T (z − 1)/(z + 1); the discrete state is (1 − A T/2) x − B T/2 u.
Sampled::Sampled(const StateSpace& system, double period_s)
    : state_(Eigen::VectorXd::Zero(system.states())), next_(state_) {
  const Index n = system.states();
  const MatrixXd one = MatrixXd::Identity(n, n), half = 0.5 * period_s * system.a;
  const MatrixXd ahead = (one - half).inverse();
  discrete_.a = (one + half) * ahead;
  discrete_.b = period_s * ahead * system.b;
  discrete_.c = system.c * ahead;
  discrete_.d = system.d + 0.5 * period_s * system.c * ahead * system.b;
  output_ = Eigen::VectorXd::Zero(system.outputs());
}

const Eigen::VectorXd& Sampled::step(const Eigen::VectorXd& u) {
  output_.noalias() = discrete_.c * state_;
  output_.noalias() += discrete_.d * u;
  next_.noalias() = discrete_.a * state_;
  next_.noalias() += discrete_.b * u;
  state_.swap(next_);
  return output_;
}

}  // namespace sim::loop_shaping

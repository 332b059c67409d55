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
  const auto scalar = [](double value) { return MatrixXd::Constant(1, 1, value); };
  return {scalar(-pole_per_s), scalar(1), scalar(k0 - k1 * pole_per_s), scalar(k1)};
}

StateSpace in_series(const StateSpace& first, const StateSpace& second) {
  const Index m = first.states(), n = second.states();
  StateSpace series;
  series.a = MatrixXd::Zero(m + n, m + n);
  series.a.topLeftCorner(m, m) = first.a;
  series.a.bottomLeftCorner(n, m) = second.b * first.c;
  series.a.bottomRightCorner(n, n) = second.a;
  series.b = MatrixXd(m + n, first.inputs());
  series.b << first.b, second.b * first.d;
  series.c = MatrixXd(second.outputs(), m + n);
  series.c << second.d * first.c, second.c;
  series.d = second.d * first.d;
  return series;
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
  for (const StateSpace& system : systems)
    append(all.a, system.a), append(all.b, system.b), append(all.c, system.c),
        append(all.d, system.d);
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
  const MatrixXd identity = MatrixXd::Identity(n, n), half = 0.5 * period_s * system.a;
  const MatrixXd inverse = (identity - half).inverse();
  discrete_.a = (identity + half) * inverse;
  discrete_.b = period_s * inverse * system.b;
  discrete_.c = system.c * inverse;
  discrete_.d = system.d + 0.5 * period_s * system.c * inverse * system.b;
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

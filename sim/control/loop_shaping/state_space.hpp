#pragma once
#include <Eigen/Core>
#include <span>

/// Linear systems in state space.
///
///   ẋ = A x + B u,   y = C x + D u
namespace sim::loop_shaping {

struct StateSpace {
  Eigen::MatrixXd a, b, c, d;

  Eigen::Index states() const { return a.rows(); }
  Eigen::Index inputs() const { return d.cols(); }
  Eigen::Index outputs() const { return d.rows(); }
};

/// y = gain · u.
StateSpace constant(const Eigen::MatrixXd& gain);
/// (k₁ s + k₀)/(s + p), from one input to one output.
StateSpace first_order(double k1, double k0, double pole_per_s);
/// What one system gives is what the next takes.
StateSpace in_series(const StateSpace& first, const StateSpace& then);
/// Systems that know nothing of each other: all inputs, all outputs.
StateSpace side_by_side(std::span<const StateSpace> systems);
/// C (jω − A)⁻¹ B + D.
Eigen::MatrixXcd response(const StateSpace& system, double rad_per_s);
/// Largest real part of the eigenvalues of A, 1/s; negative: stable.
double slowest_pole_per_s(const StateSpace& system);
/// The system that u = −K y closes around G: from r, with u = K (r − y), to y. G without direct
/// feed-through.
StateSpace closed(const StateSpace& plant, const StateSpace& controller);

/// The same at instants a period apart, by the trapezoidal rule:
///
///   x⁺ = Φ x + Γ u,   y = C′ x + D′ u
///
/// A state-space system to be stepped: no heap in `step`.
class Sampled {
 public:
  Sampled(const StateSpace& system, double period_s);

  /// y of this instant; then on to the next.
  const Eigen::VectorXd& step(const Eigen::VectorXd& u);
  /// It begins in a state of rest, A x = 0.
  void begin(const Eigen::VectorXd& rest) { state_ = rest; }

 private:
  StateSpace discrete_;
  Eigen::VectorXd state_, next_, output_;
};

}  // namespace sim::loop_shaping

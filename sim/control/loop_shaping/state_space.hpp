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
/// (k₁ s + k₀)/(s + p), with one input and one output.
StateSpace first_order(double k1, double k0, double pole_per_s);
/// Series connection: the output of `first` is the input of `second`.
StateSpace in_series(const StateSpace& first, const StateSpace& second);
/// Parallel systems without coupling, with all inputs and all outputs.
StateSpace side_by_side(std::span<const StateSpace> systems);
/// C (jω − A)⁻¹ B + D.
Eigen::MatrixXcd response(const StateSpace& system, double rad_per_s);
/// Largest real part of the eigenvalues of A, 1/s; negative: stable.
double slowest_pole_per_s(const StateSpace& system);
/// The closed loop of G and K from r to y, with u = K (r − y). G must have no direct feed-through.
StateSpace closed(const StateSpace& plant, const StateSpace& controller);

/// A discrete-time system, from a continuous one by the trapezoidal rule (Tustin):
///
///   x⁺ = Φ x + Γ u,   y = C′ x + D′ u
///
/// No heap in `step`.
class Sampled {
 public:
  Sampled(const StateSpace& system, double period_s);

  /// Returns y at this instant and advances the state by one period.
  const Eigen::VectorXd& step(const Eigen::VectorXd& u);
  /// Sets the state to an equilibrium, A x = 0.
  void begin(const Eigen::VectorXd& equilibrium) { state_ = equilibrium; }

 private:
  StateSpace discrete_;
  Eigen::VectorXd state_, next_, output_;
};

}  // namespace sim::loop_shaping

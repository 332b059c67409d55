#pragma once
#include <Eigen/Core>
#include <cstdint>

/// A multilayer perceptron with one hidden layer and one output:
///
///   y = c₀ + cᵀ tanh(W x + b),    ∂y/∂x = Wᵀ (c ∘ (1 − tanh²(W x + b)))
namespace sim::muscle_networks {

struct Perceptron {
  Eigen::MatrixXd hidden;  ///< [W b], hidden units × (inputs + 1)
  Eigen::VectorXd output;  ///< [c; c₀]

  Eigen::Index inputs() const { return hidden.cols() - 1; }
  Eigen::Index units() const { return hidden.rows(); }
  double value(const Eigen::VectorXd& x) const;
  void gradient(const Eigen::VectorXd& x, Eigen::VectorXd& dy_dx) const;

  /// Random weights with the units' inflection points spread over −1 … 1; output 0.
  static Perceptron drawn(Eigen::Index inputs, Eigen::Index units, std::uint64_t seed);
};

struct FitOptions {
  int max_steps = 200;  ///< evaluations; chosen
  double decay = 1e-7;  ///< weight of the sum of squared weights, relative to the mean square error
};
/// Levenberg–Marquardt on the mean square error. `x`: inputs × samples. Returns the
/// RMS residual.
double fit(Perceptron& net, const Eigen::MatrixXd& x, const Eigen::VectorXd& y,
           const FitOptions& options = {});

}  // namespace sim::muscle_networks

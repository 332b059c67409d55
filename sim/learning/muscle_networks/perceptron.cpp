#include "sim/learning/muscle_networks/perceptron.hpp"

#include <Eigen/QR>
#include <cmath>
#include <random>
#include <unsupported/Eigen/LevenbergMarquardt>

namespace sim::muscle_networks {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

double Perceptron::value(const VectorXd& x) const {
  double y = output[units()];
  for (Index k = 0; k < units(); ++k)
    y += output[k] * std::tanh(hidden.row(k).head(inputs()).dot(x) + hidden(k, inputs()));
  return y;
}

void Perceptron::gradient(const VectorXd& x, VectorXd& dy_dx) const {
  dy_dx.setZero(inputs());
  for (Index k = 0; k < units(); ++k) {
    const double t = std::tanh(hidden.row(k).head(inputs()).dot(x) + hidden(k, inputs()));
    dy_dx += output[k] * (1 - t * t) * hidden.row(k).head(inputs()).transpose();
  }
}

Perceptron Perceptron::drawn(Index inputs, Index units, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> coordinate(-1, 1);
  Perceptron net{MatrixXd(units, inputs + 1), VectorXd::Zero(units + 1)};
  for (Index k = 0; k < units; ++k) {
    VectorXd inflection(inputs);
    for (Index i = 0; i < inputs; ++i)
      net.hidden(k, i) = normal(random), inflection[i] = coordinate(random);
    net.hidden(k, inputs) = -net.hidden.row(k).head(inputs).dot(inflection);
  }
  return net;
}

namespace {

/// Residuals and their derivatives by all weights: hidden row by row, then the output's.
struct Residuals : Eigen::DenseFunctor<double> {
  const MatrixXd& x;
  const VectorXd& y;
  Perceptron net;
  double decay;

  Residuals(const Perceptron& start, const MatrixXd& inputs, const VectorXd& targets, double weight)
      : DenseFunctor(static_cast<int>(start.hidden.size() + start.output.size()),
                     static_cast<int>(targets.size() + start.hidden.size() + start.output.size())),
        x(inputs),
        y(targets),
        net(start),
        decay(std::sqrt(weight)) {}

  static VectorXd packed(const Perceptron& net) {
    VectorXd w(net.hidden.size() + net.output.size());
    w << net.hidden.reshaped(), net.output;
    return w;
  }
  void unpack(const VectorXd& w) {
    net.hidden.reshaped() = w.head(net.hidden.size());
    net.output = w.tail(net.output.size());
  }
  double sample_weight() const { return 1 / std::sqrt(static_cast<double>(y.size())); }
  /// tanh(W x + b) of all samples: units × samples.
  MatrixXd hidden_outputs() const {
    return ((net.hidden.leftCols(net.inputs()) * x).colwise() + net.hidden.col(net.inputs()))
        .array()
        .tanh();
  }
  int operator()(const VectorXd& w, VectorXd& residuals) {
    unpack(w);
    residuals.head(y.size()) =
        sample_weight() *
        ((net.output.head(net.units()).transpose() * hidden_outputs()).transpose() - y +
         VectorXd::Constant(y.size(), net.output[net.units()]));
    residuals.tail(w.size()) = decay * w;
    return 0;
  }
  int df(const VectorXd& w, MatrixXd& slopes) {
    unpack(w);
    const MatrixXd t = hidden_outputs();
    const Index n = y.size(), units = net.units(), inputs = net.inputs();
    slopes.setZero(n + w.size(), w.size());
    for (Index k = 0; k < units; ++k) {
      const VectorXd slope =
          sample_weight() * net.output[k] * (1 - t.row(k).array().square()).matrix().transpose();
      for (Index i = 0; i < inputs; ++i)
        slopes.col(i * units + k).head(n) = slope.cwiseProduct(x.row(i).transpose());
      slopes.col(inputs * units + k).head(n) = slope;
      slopes.col((inputs + 1) * units + k).head(n) = sample_weight() * t.row(k).transpose();
    }
    slopes.col(w.size() - 1).head(n).setConstant(sample_weight());
    slopes.bottomRows(w.size()).diagonal().setConstant(decay);
    return 0;
  }
};

}  // namespace

double fit(Perceptron& net, const MatrixXd& x, const VectorXd& y, const FitOptions& options) {
  Residuals residuals(net, x, y, options.decay);
  VectorXd w = Residuals::packed(net);
  Eigen::LevenbergMarquardt<Residuals> search(residuals);
  search.setMaxfev(options.max_steps);
  search.minimize(w);
  residuals.unpack(w);
  net = residuals.net;
  VectorXd remaining(residuals.values());
  residuals(w, remaining);
  return remaining.head(y.size()).norm();
}

}  // namespace sim::muscle_networks

#include "sim/control/loop_shaping/loop_curves.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>
#include <numbers>

namespace sim::loop_shaping {
namespace {

using Eigen::MatrixXcd;

Spread spread(const MatrixXcd& matrix) {
  const auto values = Eigen::JacobiSVD<MatrixXcd>(matrix).singularValues();
  return {values[0], values[values.size() - 1]};
}

}  // namespace

std::vector<LoopPoint> loop_curves(const JointLoops& loops, double low_Hz, double high_Hz,
                                   int count) {
  const StateSpace controller = loops.controller(), weight = loops.weight();
  const MatrixXcd identity = MatrixXcd::Identity(loops.plant.outputs(), loops.plant.outputs());
  std::vector<LoopPoint> points;
  for (int k = 0; k < count; ++k) {
    const double Hz = low_Hz * std::pow(high_Hz / low_Hz, k / (count - 1.0));
    const double w = 2 * std::numbers::pi * Hz;
    const MatrixXcd g = response(loops.plant, w), loop = g * response(controller, w);
    const MatrixXcd s = (identity + loop).inverse();
    points.push_back({Hz, spread(g * response(weight, w)), spread(loop), spread(s).largest,
                      spread(s * loop).largest});
  }
  return points;
}

}  // namespace sim::loop_shaping

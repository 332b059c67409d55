#include "sim/learning/experience/patterns.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace sim::experience {

using Eigen::Index;

Patterns::Patterns(std::vector<Burst> bursts) : bursts_(std::move(bursts)) {
  for (const Burst& burst : bursts_) {
    sum_[static_cast<int>(burst.of)] += 0.5 * burst.share * burst.for_s;
    end_s_ = std::max(end_s_, burst.at_s + burst.for_s);
  }
  for (const double sum : sum_)
    if (!(sum > 0))
      throw std::invalid_argument(
          "the bursts of agonists, and those of antagonists, must each sum up to more than zero");
}

double Patterns::at(Role role, double time_s) const {
  double sum = 0;
  for (const Burst& burst : bursts_) {
    const double phase = (time_s - burst.at_s) / burst.for_s;
    if (burst.of != role || phase <= 0 || phase >= 1) continue;
    sum += burst.share * 0.5 * (1 - std::cos(2 * std::numbers::pi * phase));
  }
  return sum / sum_[static_cast<int>(role)];
}

Eigen::VectorXd voltages_V(const Patterns& patterns, const Eigen::MatrixXd& drives,
                           const Eigen::VectorXd& scales_Vs, double time_s) {
  const double agonist_per_s = patterns.at(Role::agonist, time_s);
  const double antagonist_per_s = patterns.at(Role::antagonist, time_s);
  Eigen::VectorXd voltage_V = Eigen::VectorXd::Zero(drives.rows());
  for (Index m = 0; m < drives.rows(); ++m)
    for (Index d = 0; d < drives.cols(); ++d) {
      const double scale = scales_Vs[d] * drives(m, d);
      voltage_V[m] += scale * (scale > 0 ? agonist_per_s : antagonist_per_s);
    }
  return voltage_V;
}

Eigen::MatrixXd matrix_of(const std::vector<Drive>& drives, Index muscles) {
  Eigen::MatrixXd matrix(muscles, std::ssize(drives));
  for (std::size_t d = 0; d < drives.size(); ++d) {
    if (std::ssize(drives[d].shares) != muscles)
      throw std::invalid_argument("drive \"" + drives[d].name + "\" has " +
                                  std::to_string(drives[d].shares.size()) +
                                  " shares; the robot has " + std::to_string(muscles) + " muscles");
    matrix.col(static_cast<Index>(d)) =
        Eigen::Map<const Eigen::VectorXd>(drives[d].shares.data(), muscles);
  }
  return matrix;
}

}  // namespace sim::experience

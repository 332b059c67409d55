#include "sim/gap/estimation/remaining_residual.hpp"

#include <algorithm>
#include <cmath>

#include "sim/gap/residuals/signal_noise.hpp"

namespace sim::estimation {
namespace {

std::vector<double> excess(const ResidualVector& residuals, const Eigen::VectorXd& z) {
  constexpr double median_of_chi_square = 0.455;  // one degree of freedom
  constexpr double largest_square = 36;           // six standard deviations; chosen
  std::vector<std::vector<double>> square(residuals.stages());
  for (const Block& b : residuals.blocks())
    for (Eigen::Index k = b.first; k < b.first + b.count; ++k)
      if (z[k] != 0) square[b.stage].push_back(z[k] * z[k]);
  std::vector<double> excess;
  for (auto& of_stage : square) {
    if (of_stage.empty()) {
      excess.push_back(0);
      continue;
    }
    const double limit =
        largest_square * std::max(1.0, sim::residuals::median(of_stage) / median_of_chi_square);
    double sum = 0;
    for (const double x : of_stage) sum += std::min(x, limit);
    excess.push_back(sum / double(of_stage.size()) - 1);
  }
  return excess;
}

}  // namespace

RemainingResidual remaining_residual(const ResidualVector& residuals, const Explained& explained,
                                     const Eigen::VectorXd& z) {
  return {excess(residuals, z), residuals.floor_ratio(explained)};
}

RemainingResidual remaining_residual(const ResidualVector& residuals, const RemainingResidual& base,
                                     const Eigen::VectorXd& z) {
  return {excess(residuals, z), base.floor_ratio};
}

double misfit(const RemainingResidual& remaining, const ResidualVector& residuals,
              std::size_t stage) {
  constexpr double law_weight = 0.25, tolerated_ratio = 1.5;
  return law_weight * residuals.independent()[stage] *
         (std::log1p(std::max(0.0, remaining.excess[stage])) +
          2 * std::log(std::max(1.0, remaining.floor_ratio[stage] / tolerated_ratio)));
}

double misfit(const RemainingResidual& remaining, const ResidualVector& residuals) {
  double sum = 0;
  for (std::size_t s = 0; s < remaining.excess.size(); ++s) sum += misfit(remaining, residuals, s);
  return sum;
}

}  // namespace sim::estimation

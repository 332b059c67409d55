#include "sim/gap/diagnosis/sensitivity.hpp"

#include <Eigen/QR>
#include <cmath>
#include <span>

#include "interfaces/parallel/in_parallel.hpp"
#include "sim/gap/diagnosis/screening.hpp"
#include "sim/gap/residuals/indices.hpp"

namespace sim::diagnosis {
namespace {

using effects::Placed;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// z of all recordings, 0 in windows that are not evaluated.
VectorXd z_of(const Evaluator& evaluator, const Evaluation& evaluation) {
  std::vector<double> all;
  for (std::size_t e = 0; e < evaluator.episodes().size(); ++e)
    for (const double z : evaluator.whitened(evaluation, e)) all.push_back(std::isnan(z) ? 0 : z);
  return Eigen::Map<VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()));
}

Sensitivity sensitivity_of(const Evaluator& evaluator, const VectorXd& nominal_evaluation,
                           const Placed& neutral) {
  const auto all = each(evaluator.episodes().size());
  const auto variants = perturbations(neutral);  // a small and a larger one of each parameter
  MatrixXd changes(nominal_evaluation.size(), static_cast<Eigen::Index>(variants.size()) / 2);
  Sensitivity sensitivity;
  for (Eigen::Index k = 0; k < changes.cols(); ++k)
    for (const Placed& perturbed : std::span(variants).subspan(std::size_t(2 * k), 2)) {
      changes.col(k) =
          z_of(evaluator, evaluator.with(evaluator.nominal_evaluation(), perturbed, all)) -
          nominal_evaluation;
      if (k == 0) sensitivity.perturbed = perturbed;
      if (changes.col(k).norm() > visible_change) break;
    }
  const Eigen::ColPivHouseholderQR<MatrixXd> parts(changes);
  sensitivity.first = changes.col(0);
  sensitivity.span =
      parts.householderQ() * MatrixXd::Identity(nominal_evaluation.size(), parts.rank());
  return sensitivity;
}

}  // namespace

std::vector<Sensitivity> sensitivities(const Evaluator& evaluator,
                                       const std::vector<std::string>& withhold, int threads) {
  const VectorXd nominal_evaluation = z_of(evaluator, evaluator.nominal_evaluation());
  const auto all = candidates(evaluator, withhold);
  std::vector<Sensitivity> sensitivities(all.size());
  in_parallel(all.size(), threads, [&](std::size_t k) {
    sensitivities[k] = sensitivity_of(evaluator, nominal_evaluation, all[k]);
  });
  return sensitivities;
}

}  // namespace sim::diagnosis

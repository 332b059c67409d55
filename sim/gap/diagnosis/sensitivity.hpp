#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "sim/gap/diagnosis/evaluation.hpp"

/// What a small effect changes in the residuals of recordings, in units of noise: δz, 0 where nothing
/// is judged. As if laws were linear.
namespace sim::diagnosis {

constexpr double shown = 1;  ///< |δz|, standard deviations: less is not seen at all

struct Sensitivity {
  effects::Placed perturbed;  ///< 0.3 % of the range, or 10 % where that does not show
  Eigen::VectorXd first;      ///< δz by its first parameter
  Eigen::MatrixXd span;  ///< δz by each of its parameters, orthonormal; no column: nothing changes
};

/// Of every effect of the library at every place, but those of types withheld.
std::vector<Sensitivity> sensitivities(const Evaluator& evaluator,
                                       const std::vector<std::string>& withhold, int threads);

}  // namespace sim::diagnosis

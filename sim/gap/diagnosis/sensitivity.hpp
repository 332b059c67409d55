#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "sim/gap/diagnosis/evaluation.hpp"

/// Sensitivity: change δz of the residuals by a small effect, in units of noise. It is 0 in windows
/// that are not evaluated. Laws are linearized.
namespace sim::diagnosis {

constexpr double visible_change = 1;  ///< smallest visible |δz|, in standard deviations

struct Sensitivity {
  effects::Placed perturbed;  ///< by 0.3 % of the range, or 10 % if that is not visible
  Eigen::VectorXd first;      ///< δz by its first parameter
  Eigen::MatrixXd span;  ///< orthonormal basis of δz by all its parameters; no column: no change
};

/// Sensitivities of every effect of the library at every place, except types in `withhold`.
std::vector<Sensitivity> sensitivities(const Evaluator& evaluator,
                                       const std::vector<std::string>& withhold, int threads);

}  // namespace sim::diagnosis

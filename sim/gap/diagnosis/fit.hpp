#pragma once
#include <span>
#include <vector>

#include "sim/gap/diagnosis/evaluation.hpp"

/// An effect's parameters from recordings: least squares of z (trial.hpp) within the effect's
/// bounds, by Levenberg–Marquardt (Ceres), from several starts where a parameter shapes the law.
namespace sim::diagnosis {

struct FitOptions {
  int iterations = 12;
  /// Parameters beyond the first also start at these shares of their bounds, on a log scale.
  std::vector<double> shape_starts = {0.15, 0.6};
};

struct Fit {
  effects::Placed placed;
  double square = 0;                   ///< Σ z² on the recordings of the fit
  std::vector<double> values, sigmas;  ///< of its fitted parameters
};

/// Whether `value` is at a bound of the parameter, other than a bound that is the neutral value itself.
bool is_at_bound(const effects::Parameter& neutral, double value);
/// Whether the first parameter of an effect, its size, is at a bound.
bool has_size_at_bound(const effects::Placed& placed);

/// Fits the effect `more` to the recordings `episodes`, on top of `base`; starts at its parameters
/// when they are not neutral.
Fit fit(const Evaluator& evaluator, const Evaluation& base, const effects::Placed& more,
        std::span<const std::size_t> episodes, const FitOptions& options = {});

/// Fits several effects together, from where they are.
std::vector<Fit> fit_together(const Evaluator& evaluator, std::span<const effects::Placed> all,
                              std::span<const std::size_t> episodes,
                              const FitOptions& options = {});

}  // namespace sim::diagnosis

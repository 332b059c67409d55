#pragma once
#include <span>
#include <vector>

#include "sim/gap/diagnosis/evaluation.hpp"

/// Parameters of effects from recordings: least squares of z (evaluation.hpp) within the bounds, by
/// the method of Levenberg and Marquardt (Ceres). Several starts are used if a parameter changes
/// the form of the law.
namespace sim::diagnosis {

struct FitOptions {
  int iterations = 12;
  /// The second parameter also starts at these fractions of its bounds, on a logarithmic scale;
  /// chosen.
  std::vector<double> shape_starts = {0.15, 0.6};
};

struct Fit {
  effects::Placed placed;
  double square = 0;                   ///< Σ z² on the recordings of the fit
  std::vector<double> values, sigmas;  ///< of the fitted parameters
};

/// Whether `value` is at a bound of the parameter, other than a bound that is the neutral value
/// itself.
bool is_at_bound(const effects::Parameter& neutral, double value);
/// Whether the first parameter of an effect, its size, is at a bound.
bool has_size_at_bound(const effects::Placed& placed);

/// Fits the effect `added` to `episodes`, in addition to `base`. Starts at its values unless they
/// are neutral.
Fit fit(const Evaluator& evaluator, const Evaluation& base, const effects::Placed& added,
        std::span<const std::size_t> episodes, const FitOptions& options = {});

/// Fits several effects jointly, starting at their values.
std::vector<Fit> fit_jointly(const Evaluator& evaluator, std::span<const effects::Placed> all,
                             std::span<const std::size_t> episodes, const FitOptions& options = {});

}  // namespace sim::diagnosis

#pragma once
#include <span>
#include <vector>

#include "sim/gap/diagnosis/evaluation.hpp"

/// Initial guesses of a fit. They are needed for laws whose gradient at the neutral value does not
/// lead to the optimum.
namespace sim::diagnosis {

/// Whether all parameters of an effect have their neutral values.
bool is_neutral(const effects::Placed& placed);

/// Returns initial guesses of an effect: stops at the extreme angles of the joint, bones of several
/// stiffnesses. Empty for most effects.
std::vector<effects::Placed> initial_guesses(const Evaluator& evaluator,
                                             const effects::Placed& neutral,
                                             std::span<const std::size_t> episodes);

/// Returns the initial guess, or the fraction of the first parameter's bounds, with the smallest Σ
/// z² in addition to `base`. Returns `effect` if it is not neutral, or if no guess is better.
effects::Placed best_initial_guess(const Evaluator& evaluator, const Evaluation& base,
                                   const effects::Placed& effect,
                                   std::span<const std::size_t> episodes);

}  // namespace sim::diagnosis

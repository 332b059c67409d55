#pragma once
#include <span>
#include <vector>

#include "sim/gap/diagnosis/evaluation.hpp"

/// Where a fit begins, for laws that a small step from neutral does not lead to.
namespace sim::diagnosis {

/// Its parameters change nothing.
bool is_neutral(const effects::Placed& placed);

/// Parameters worth a try: stops where the joint turned back, bones of several stiffnesses. Empty
/// for most.
std::vector<effects::Placed> initial_guesses(const Evaluator& evaluator,
                                             const effects::Placed& neutral,
                                             std::span<const std::size_t> episodes);

/// The one of the tries, and of some shares of the first parameter's bounds, that leaves least on
/// top of `base`; the effect as given if it is not neutral, or none leaves less.
effects::Placed best_initial_guess(const Evaluator& evaluator, const Evaluation& base,
                                   const effects::Placed& more,
                                   std::span<const std::size_t> episodes);

}  // namespace sim::diagnosis

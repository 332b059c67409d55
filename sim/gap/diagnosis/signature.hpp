#pragma once
#include <vector>

#include "sim/gap/diagnosis/answer.hpp"
#include "sim/gap/diagnosis/problem.hpp"

namespace sim::diagnosis {

/// Sets `signature` and `likeness` of each candidate from its change on the held-out recordings. Clears the
/// evaluations of `ranked`, which are large.
void compute_signatures(const Problem& problem, const Evaluator& evaluator,
                        const std::vector<StageGap>& stages, std::vector<Ranked>& ranked,
                        std::vector<IdentifiedEffect>& names);

}  // namespace sim::diagnosis

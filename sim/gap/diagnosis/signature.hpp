#pragma once
#include <vector>

#include "sim/gap/diagnosis/answer.hpp"
#include "sim/gap/diagnosis/problem.hpp"

namespace sim::diagnosis {

/// What each candidate changes on the held-out recordings: its share at each of `stages`, and how
/// like the change of the first candidate it is. Takes the candidates' trials, which are large.
void compute_signatures(const Problem& problem, const Evaluator& evaluator,
                        const std::vector<StageGap>& stages, std::vector<Ranked>& ranked,
                        std::vector<IdentifiedEffect>& names);

}  // namespace sim::diagnosis

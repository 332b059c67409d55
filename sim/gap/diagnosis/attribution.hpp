#pragma once
#include <optional>
#include <vector>

#include "sim/gap/diagnosis/direct_detection.hpp"
#include "sim/gap/diagnosis/residual_profile.hpp"
#include "sim/gap/diagnosis/selection.hpp"

/// Where the gap lies, told from its cause when that is known and from the open stages when not.
namespace sim::diagnosis {

/// A part of the gap: a stage of the whole chain, bus to sensors, as far as it can be told.
struct Attribution {
  effects::Stage stage;
  std::string on;
  double share = 0;
  Interval interval;
  std::vector<Region> when;
};

/// What no effect explains.
struct Unexplained {
  effects::Stage stage;
  std::string on;
  double excess = 0;
  std::optional<ResidualProfile> shape;
};

/// Of effects that explain the gap, each its share of what they close, in the order of the answer;
/// places that cannot be told apart share one, and any of them may have all of it. The bus beside
/// others has a share of 0: it changes no residual.
std::vector<Attribution> where_of_answer(const Problem& problem, const Evaluator& plain,
                                         const std::vector<StageGap>& stages,
                                         const std::vector<IdentifiedEffect>& answer);

/// Without an answer: the parts of the chain that could leave such a gap (isolation.hpp), in equal
/// shares, the one whose effects come nearest to closing it first; the open stages where no single
/// part could.
std::vector<Attribution> where_of_stages(const Problem& problem, const Evaluator& plain,
                                         const std::vector<StageGap>& stages,
                                         const std::vector<IdentifiedEffect>& ranked);

/// The stages that the selection leaves open, with the map that explains most of each; where it
/// leaves none open, those that keep more than noise all the same, and are small beside the gap.
std::vector<Unexplained> unexplained(const Problem& problem, const Evaluator& evaluator,
                                     const Selection& selection);

}  // namespace sim::diagnosis

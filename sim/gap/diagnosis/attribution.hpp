#pragma once
#include <optional>
#include <vector>

#include "sim/gap/diagnosis/direct_detection.hpp"
#include "sim/gap/diagnosis/residual_profile.hpp"
#include "sim/gap/diagnosis/selection.hpp"

/// Location of the gap: the location of its cause if that is identified, otherwise derived from the
/// open stages.
namespace sim::diagnosis {

/// A part of the robot, from bus to sensors, to which a fraction of the gap is attributed.
struct Attribution {
  effects::Stage stage;
  std::string on;
  double share = 0;
  Interval interval;
  std::vector<Region> when;
};

/// A stage whose residual is above noise with the answer.
struct Unexplained {
  effects::Stage stage;
  std::string on;
  double excess = 0;
  std::optional<ResidualProfile> shape;
};

/// For effects that explain the gap: the fraction of the closed gap of each, in the order of the
/// answer. Indistinguishable places divide one share equally; the interval of each extends from 0
/// to the whole share. With other effects, the bus has a share of 0 because it changes no residual.
std::vector<Attribution> attribute_to_answer(const Problem& problem, const Evaluator& baseline,
                                             const std::vector<StageGap>& stages,
                                             const std::vector<IdentifiedEffect>& answer);

/// Without an answer: the parts that can cause the gap (isolation.hpp), with equal shares, the part
/// with the effect of highest gain first. If no single part can cause it: the open stages.
std::vector<Attribution> attribute_to_parts(const Problem& problem, const Evaluator& baseline,
                                            const std::vector<StageGap>& stages,
                                            const std::vector<IdentifiedEffect>& ranked);

/// The stages that are open with the selection, each with the profile that explains most of its
/// residual. If no stage is open: the stages with a small residual above noise.
std::vector<Unexplained> unexplained(const Problem& problem, const Evaluator& evaluator,
                                     const Selection& selection);

}  // namespace sim::diagnosis

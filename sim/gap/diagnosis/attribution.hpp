#pragma once
#include <optional>
#include <vector>

#include "sim/gap/diagnosis/direct_detection.hpp"
#include "sim/gap/diagnosis/residual_profile.hpp"
#include "sim/gap/diagnosis/selection.hpp"

/// Location of the gap: that of its cause if identified, otherwise derived from the open stages.
namespace sim::diagnosis {

/// A part of the robot, from bus to sensors, to which a share of the gap is attributed.
struct Attribution {
  effects::Stage stage;
  std::string on;
  double share = 0;
  Interval interval;
  std::vector<Region> when;
};

/// A stage that keeps a residual above noise with the answer.
struct Unexplained {
  effects::Stage stage;
  std::string on;
  double excess = 0;
  std::optional<ResidualProfile> shape;
};

/// For effects that explain the gap: the share of each in what they close, in the order of the answer.
/// Indistinguishable places divide one share equally; the interval of each extends from 0 to all of it.
/// The bus beside other effects has a share of 0 because it changes no residual.
std::vector<Attribution> attribute_to_answer(const Problem& problem, const Evaluator& plain,
                                             const std::vector<StageGap>& stages,
                                             const std::vector<IdentifiedEffect>& answer);

/// Without an answer: the parts that can cause the gap (isolation.hpp), in equal shares, the part with the
/// effect of highest gain first. If no single part can cause it: the open stages.
std::vector<Attribution> attribute_to_parts(const Problem& problem, const Evaluator& plain,
                                            const std::vector<StageGap>& stages,
                                            const std::vector<IdentifiedEffect>& ranked);

/// The stages that the selection leaves open, each with the profile that explains most of its residual.
/// If none is open: the stages with a residual above noise that is small compared with the gap.
std::vector<Unexplained> unexplained(const Problem& problem, const Evaluator& evaluator,
                                     const Selection& selection);

}  // namespace sim::diagnosis

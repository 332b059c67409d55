#pragma once
#include <functional>
#include <vector>

#include "sim/gap/diagnosis/answer.hpp"
#include "sim/gap/diagnosis/problem.hpp"

/// Forward selection of effects: the best single effect, then further ones while a stage stays open; each
/// is reconsidered when another is added. If a stage stays open, the same effect on every actuator with an
/// open stage is tried; it is also taken if it needs no more effects and leaves a smaller Σ z².
namespace sim::diagnosis {

struct Selection {
  bool gap = false;   ///< some stage is open
  bool shown = true;  ///< whether the held-out recordings show the gap well enough
  std::vector<IdentifiedEffect> ranked = {};  ///< effects fitted one by one, best first
  std::vector<Ranked> alone = {};             ///< the same with their fits
  std::vector<IdentifiedEffect> answer = {};  ///< effects that close the gap together, by gain
  std::vector<StageGap> left = {};  ///< remaining residual with the answer, held-out recordings
  Evaluation evaluation = {};       ///< with the answer
  double interaction = 0;  ///< share of the gap: closed by the answer minus the sum of each alone

  bool explained() const;  ///< there is an answer, and no stage is open
};

/// Extent of the selection: the best single effect, or further effects too.
enum class Depth { best_alone, full };

/// `stages`: the columns of the signatures. `earlier`: a selection on the same robot, whose ranking is reused; without
/// one every effect is fitted.
Selection select(const Problem& problem, const Evaluator& evaluator,
                 const std::vector<StageGap>& stages, Depth depth = Depth::full,
                 Selection earlier = {});

/// Whether a stage is unexplained that keeps `excess` of its nominal excess `was`. The function
/// returns the part of the remaining residual that depends on one variable; it is called only if it decides.
bool stays_open(double excess, double was, const Tolerance& tolerance,
                const std::function<double()>& explained_by_one_variable);

/// All stages on the held-out recordings; open: unexplained by `evaluation`.
std::vector<StageGap> unexplained_stages(const Problem& problem, const Evaluator& evaluator,
                                         const Evaluation& evaluation, const Tolerance& tolerance);

}  // namespace sim::diagnosis

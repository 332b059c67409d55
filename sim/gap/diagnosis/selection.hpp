#pragma once
#include <functional>
#include <vector>

#include "sim/gap/diagnosis/answer.hpp"
#include "sim/gap/diagnosis/problem.hpp"

/// Forward selection of effects: the best single effect, then further effects while a stage is
/// open. Each is reconsidered when another is added. If a stage is still open, the same effect on
/// every actuator with an open stage is fitted. It is chosen if it explains the gap, or if it has
/// no more effects and a smaller Σ z².
namespace sim::diagnosis {

struct Selection {
  bool gap = false;        ///< a stage is open
  bool is_visible = true;  ///< whether the held-out recordings show the gap well enough
  std::vector<IdentifiedEffect> ranked = {};  ///< individually fitted effects, the best first
  std::vector<Ranked> single_fits = {};       ///< the fits of `ranked`
  std::vector<IdentifiedEffect> answer = {};  ///< effects that jointly close the gap, by gain
  std::vector<StageGap> remaining =
      {};                      ///< remaining residual with the answer, held-out recordings
  Evaluation evaluation = {};  ///< with the answer
  double interaction = 0;      ///< gap closed by the answer minus the sum of each effect, fraction

  bool explained() const;  ///< there is an answer, and no stage is open
};

/// Extent of the selection: only the best single effect, or several effects.
enum class Depth { best_single, full };

/// Selects effects. `stages`: the columns of the signatures. `earlier`: a selection on the same
/// robot, whose ranking is reused; if it is empty, every effect is fitted.
Selection select(const Problem& problem, const Evaluator& evaluator,
                 const std::vector<StageGap>& stages, Depth depth = Depth::full,
                 Selection earlier = {});

/// Whether a stage with the remaining `excess` and the excess `before` is unexplained. The function
/// returns the part of the remaining residual that depends on one variable. It is called only if
/// the result depends on it.
bool stays_open(double excess, double before, const Tolerance& tolerance,
                const std::function<double()>& explained_by_one_variable);

/// Returns all stages on the held-out recordings; open: unexplained by `evaluation`.
std::vector<StageGap> unexplained_stages(const Problem& problem, const Evaluator& evaluator,
                                         const Evaluation& evaluation, const Tolerance& tolerance);

}  // namespace sim::diagnosis

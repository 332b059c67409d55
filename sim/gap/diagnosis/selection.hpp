#pragma once
#include <functional>
#include <vector>

#include "sim/gap/diagnosis/answer.hpp"
#include "sim/gap/diagnosis/problem.hpp"

/// Which effects together explain the residuals: the best alone, others on top of it while a stage
/// stays open, each reconsidered when another joins; where that leaves one open, or takes as many and
/// leaves more, the same effect on every actuator that differs.
namespace sim::diagnosis {

struct Selection {
  bool gap = false;   ///< some stage leaves its floor
  bool shown = true;  ///< false: the recordings held out show too little of it to judge an effect
  std::vector<IdentifiedEffect> ranked = {};  ///< one by one, best first
  std::vector<Ranked> alone = {};             ///< the same with their fits
  std::vector<IdentifiedEffect> answer =
      {};                           ///< effects that together close the gap, the most telling first
  std::vector<StageGap> left = {};  ///< after the answer, held-out recordings
  Evaluation evaluation = {};       ///< with the answer
  double interaction = 0;  ///< of the gap: what the answer closes less what each does alone

  bool explained() const;  ///< there is an answer, and no stage stays open
};

/// How far to look: for the best alone, or for others on top of it too.
enum class Depth { best_alone, full };

/// `stages`: the columns of the signatures. `earlier`: a selection on the same robot, whose ranking is reused; without
/// one every effect is fitted.
Selection select(const Problem& problem, const Evaluator& evaluator,
                 const std::vector<StageGap>& stages, Depth depth = Depth::full,
                 Selection earlier = {});

/// Whether a stage that keeps `excess` of what `was` there is not explained. `follows`: how much of the
/// rest follows one variable, asked only where that decides.
bool stays_open(double excess, double was, const Tolerance& tolerance,
                const std::function<double()>& follows);

/// The stages that `trial` leaves open on the held-out recordings.
std::vector<StageGap> unexplained_stages(const Problem& problem, const Evaluator& evaluator,
                                         const Evaluation& evaluation, const Tolerance& tolerance);

}  // namespace sim::diagnosis

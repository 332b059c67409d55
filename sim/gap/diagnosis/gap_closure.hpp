#pragma once
#include <vector>

#include "sim/gap/diagnosis/selection.hpp"

/// How far the answer closes the gap, on held-out recordings.
///
/// `known`: trials of the robot with what was seen without a fit. Where a sensor is coarser than
/// its data sheet, its noise is no gap: what is left counts as far as it is beyond that noise.
namespace sim::diagnosis {

/// An error before and after.
struct Closed {
  std::string channel;  ///< stage and place, or "all"
  std::string unit;
  double before = 0, floor = 0, after = 0;  ///< rms
  double driven_by = 0;                     ///< rms of what drives the stage; 0: nothing to name
  double closed = 0;                        ///< (before − after)/(before − floor)
  Interval interval;
  /// There is something to close; of less, `closed` is a ratio of noise to noise.
  bool has_gap() const { return before > 1.5 * floor; }
};

/// Stage by stage, in its unit.
std::vector<Closed> closed_by_stage(const Problem& problem, const Evaluator& plain,
                                    const Evaluator& known, const Evaluation& evaluation);
/// Over all stages, in units of noise.
Closed closed_overall(const Problem& problem, const Evaluator& plain, const Evaluator& known,
                      const Evaluation& evaluation);

/// A few seconds of a stage's residual in a held-out recording, where it is worst.
struct WorstWindow {
  effects::Stage stage;
  std::string on, unit, recording;
  double floor = 0;
  std::vector<double> time_s, before, after;
};

/// Of the stages that are most open.
std::vector<WorstWindow> worst_windows(const Problem& problem, const Evaluator& plain,
                                       const Evaluation& evaluation,
                                       const std::vector<StageGap>& stages);

}  // namespace sim::diagnosis

#pragma once
#include <vector>

#include "sim/gap/diagnosis/selection.hpp"

/// Gap closure: the part of the gap that the answer closes, on held-out recordings.
///
/// `known`: evaluator of the robot with directly detected effects. If a sensor is coarser than its data
/// sheet, its noise is no gap: only the remaining residual above that noise counts.
namespace sim::diagnosis {

/// An error with the nominal robot and with the answer.
struct Closed {
  std::string channel;  ///< stage and place, or "all"
  std::string unit;
  double before = 0, floor = 0, after = 0;  ///< rms
  double driven_by = 0;                     ///< rms of the input of the stage; 0: no single input
  double closed = 0;                        ///< (before − after)/(before − floor)
  Interval interval;
  /// Whether there is a gap to close; otherwise `closed` is a ratio of noise to noise.
  bool has_gap() const { return before > 1.5 * floor; }
};

/// By stage, each in its unit.
std::vector<Closed> closed_by_stage(const Problem& problem, const Evaluator& plain,
                                    const Evaluator& known, const Evaluation& evaluation);
/// Over all stages, in units of noise.
Closed closed_overall(const Problem& problem, const Evaluator& plain, const Evaluator& known,
                      const Evaluation& evaluation);

/// A few seconds of a stage's residual in a held-out recording around its largest value.
struct WorstWindow {
  effects::Stage stage;
  std::string on, unit, recording;
  double floor = 0;
  std::vector<double> time_s, before, after;
};

/// For the open stages with the largest shares.
std::vector<WorstWindow> worst_windows(const Problem& problem, const Evaluator& plain,
                                       const Evaluation& evaluation,
                                       const std::vector<StageGap>& stages);

}  // namespace sim::diagnosis

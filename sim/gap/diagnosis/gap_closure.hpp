#pragma once
#include <vector>

#include "sim/gap/diagnosis/selection.hpp"

/// Gap closure: the part of the gap that the answer closes, on held-out recordings.
///
/// `corrected`: evaluator of the robot with directly detected effects. If a sensor is coarser than
/// its data sheet, its noise is not part of the gap: only the remaining residual above that noise
/// is.
namespace sim::diagnosis {

/// An error with the nominal robot and with the answer.
struct ClosedGap {
  std::string channel;  ///< stage and place, or "all"
  std::string unit;
  double before = 0, floor = 0, after = 0;  ///< rms
  double driven_by = 0;                     ///< rms of the input of the stage; 0: no single input
  double closed = 0;                        ///< (before − after)/(before − floor)
  Interval interval;
  /// Whether there is a gap to close; otherwise `closed` is a ratio of noise to noise.
  bool has_gap() const { return before > 1.5 * floor; }
};

/// Gap closure of each stage, in its unit.
std::vector<ClosedGap> closed_by_stage(const Problem& problem, const Evaluator& baseline,
                                       const Evaluator& corrected, const Evaluation& evaluation);
/// Gap closure over all stages, in units of noise.
ClosedGap closed_overall(const Problem& problem, const Evaluator& baseline,
                         const Evaluator& corrected, const Evaluation& evaluation);

/// The residual of a stage in a held-out recording, for 2.5 s on both sides of its largest value.
struct WorstWindow {
  effects::Stage stage;
  std::string on, unit, recording;
  double floor = 0;
  std::vector<double> time_s, before, after;
};

/// The worst windows of the three open stages with the largest shares.
std::vector<WorstWindow> worst_windows(const Problem& problem, const Evaluator& baseline,
                                       const Evaluation& evaluation,
                                       const std::vector<StageGap>& stages);

}  // namespace sim::diagnosis

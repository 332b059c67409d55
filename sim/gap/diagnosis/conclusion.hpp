#pragma once
#include "sim/gap/diagnosis/diagnose.hpp"
#include "sim/gap/diagnosis/direct_detection.hpp"
#include "sim/gap/diagnosis/problem.hpp"
#include "sim/gap/diagnosis/selection.hpp"

/// Writes an answer into the diagnosis: verdict, place, cause, and how much of the gap it closes.
namespace sim::diagnosis {

/// What a question is answered from.
struct Question {
  const Problem& problem;
  const erp::Robot& robot;  ///< with what was seen without a fit
  const Evaluator& plain;   ///< of the robot as it is given
  const Evaluator& known;   ///< of `robot`
  const Detected& detected;
};

/// Takes the answer of sim/gap/estimation: effects and constants estimated together.
void conclude(const Question& q, const JointEstimate& built, Selection selection, Diagnosis& d);
/// Takes the answer of a selection of effects on the robot's constants as given.
void conclude(const Question& q, const Selection& selection, Diagnosis& d);

}  // namespace sim::diagnosis

#pragma once
#include "sim/gap/diagnosis/diagnose.hpp"
#include "sim/gap/diagnosis/direct_detection.hpp"
#include "sim/gap/diagnosis/problem.hpp"
#include "sim/gap/diagnosis/selection.hpp"

/// Writes an answer into the diagnosis: verdict, attribution, cause and gap closure.
namespace sim::diagnosis {

/// Inputs of a diagnosis.
struct Question {
  const Problem& problem;
  const erp::Robot& robot;     ///< the given robot with the directly detected effects on sensors
  const Evaluator& baseline;   ///< of the given robot
  const Evaluator& corrected;  ///< of `robot`
  const Detected& detected;
};

/// Writes the answer of the joint estimate: jointly estimated effects and constants.
void conclude(const Question& q, const JointEstimate& built, Selection selection, Diagnosis& d);
/// Writes the answer of a selection of effects with the given constants.
void conclude(const Question& q, const Selection& selection, Diagnosis& d);

}  // namespace sim::diagnosis

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
  const erp::Robot& robot;  ///< as given, with the directly detected effects on sensors
  const Evaluator& plain;   ///< of the robot as given
  const Evaluator& known;   ///< of `robot`
  const Detected& detected;
};

/// Takes the answer of the joint estimate: effects and constants estimated together.
void conclude(const Question& q, const JointEstimate& built, Selection selection, Diagnosis& d);
/// Takes the answer of a selection of effects on the robot's constants as given.
void conclude(const Question& q, const Selection& selection, Diagnosis& d);

}  // namespace sim::diagnosis

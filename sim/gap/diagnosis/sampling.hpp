#pragma once
#include <optional>
#include <string>

#include "sim/gap/diagnosis/evaluation.hpp"

/// Whether the rows of a drive's recordings are close enough in time to determine its friction.
///
///   fraction = rows at which the shaft reverses / rows at which it moves
///
/// Around a reversal friction acts in both directions, and the instant of the change is unknown.
namespace sim::diagnosis {

/// Returns this fraction.
double reversal_fraction(const Evaluator& evaluator);

/// Returns the reason why friction is not determined. Empty if it is determined, or if the robot
/// has no drive.
std::optional<std::string> rows_too_far_apart(const Evaluator& evaluator);

}  // namespace sim::diagnosis

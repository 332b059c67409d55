#pragma once
#include <optional>
#include <string>

#include "sim/gap/diagnosis/evaluation.hpp"

/// Whether the rows of a drive's recordings are close enough in time to determine its friction.
///
///   share = rows at which the shaft reverses / rows at which it moves
///
/// Around such a row friction acts in both directions, and the instant of the change is unknown.
namespace sim::diagnosis {

/// The share above.
double reversal_share(const Evaluator& evaluator);

/// Reason why friction is not determined. Empty if it is, or if the robot has no drive.
std::optional<std::string> rows_too_far_apart(const Evaluator& evaluator);

}  // namespace sim::diagnosis

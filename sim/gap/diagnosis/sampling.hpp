#pragma once
#include <optional>
#include <string>

#include "sim/gap/diagnosis/evaluation.hpp"

/// Whether the rows of a drive's recordings are near enough to each other to determine its friction.
///
///   share = rows at which the shaft turns the other way than before / rows about which it turns
///
/// In a period about such a row friction acts both ways, and where it changes is not known.
namespace sim::diagnosis {

double turned_back(const Evaluator& evaluator);

/// Why friction is not determined; nothing: it is, or the robot has no drive.
std::optional<std::string> rows_too_far_apart(const Evaluator& evaluator);

}  // namespace sim::diagnosis

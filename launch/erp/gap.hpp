#pragma once
#include <iosfwd>
#include <string>
#include <vector>

/// `erp gap`: where recordings and a robot's model part.
namespace launch {

/// Prints a row a stage, the largest share of the gap first, and the stages that leave their noise
/// floor in words; what was mended in the recordings goes to `remarks`. Throws xml::Errors,
/// RecordingError, std::invalid_argument. Returns the exit code.
int gap_where(const std::string& robot_file, const std::vector<std::string>& recordings,
              std::ostream& out, std::ostream& remarks);

}  // namespace launch

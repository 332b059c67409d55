#pragma once
#include <iosfwd>
#include <string>

/// `erp model loops`: H-infinity control loops of the hinges of a robot, designed from its model.
namespace launch {

struct ModelLoopsOptions {
  std::string robot, loops;  ///< robot.xml; loop shape file, or empty for the default
  std::string poses;         ///< CSV of postures to check; empty: the starting posture only
  std::string out;           ///< picture file; empty: none
};

/// Prints the stability margin of the design and of each posture; draws the singular values of the
/// loops. Throws xml::Errors, RecordingError, std::invalid_argument. Returns the exit code: 0
/// stable in all postures, 1 not.
int model_loops(const ModelLoopsOptions& options, std::ostream& out);

}  // namespace launch

#pragma once
#include <iosfwd>
#include <string>

/// `erp model loops`: H-infinity loops around a robot's hinges, designed from its model.
namespace launch {

struct ModelLoopsOptions {
  std::string robot, loops;  ///< robot.xml; the loops' shape, or empty for the usual one
  std::string poses;         ///< CSV of postures in which they are tried; empty: the start alone
  std::string out;           ///< a picture; empty: none
};

/// Prints the stability margin, and what is left of it in each posture; draws the loops' singular
/// values. Throws xml::Errors, RecordingError, std::invalid_argument. Returns the exit code: 0
/// stable in all postures, 1 not.
int model_loops(const ModelLoopsOptions& options, std::ostream& out);

}  // namespace launch

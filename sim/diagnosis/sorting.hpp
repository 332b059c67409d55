#pragma once
#include "sim/diagnosis/diagnose.hpp"
#include "sim/diagnosis/evidence.hpp"

/// Recordings sorted into those to learn from and those to judge by.
namespace sim::diagnosis {

/// As the options have them, else by conditions alone (split.hpp).
Sets first_sets(const Evidence& evidence);

/// Recordings of which the first part is to learn from, the rest to judge by.
struct CutRecordings {
  std::vector<Shared> shared;
  std::vector<std::string> warnings;  ///< why each was cut
};

/// Sorts the recordings, unless the options do, so that both sides show what the robot of `by` leaves open; one that
/// alone shows it is cut in two. What a robot as described hides, as a stop behind constants that are a
/// little off, shows with the robot as built. True: recordings changed sides or were cut.
bool sort_recordings(Evidence& evidence, const Trials& by, CutRecordings& cut);

}  // namespace sim::diagnosis

#pragma once
#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

/// `erp gap blind`: cases with something hidden, diagnosed without knowing it, then scored.
///
///   DIR/robot.xml, DIR/cases.json           what the diagnosis may see: the robot, the recordings
///   DIR/<case>/1.csv …                      of each case, and the SHA-256 of the truth
///   DIR/<case>/diagnosis.json               what it found
///   TRUTH                                   what was hidden, apart
namespace launch::gap {

struct BlindMakeOptions {
  std::string robot, out, truth, kind = "single";
  int cases = 10, recordings = 4, threads = 2;
  double seconds = 10;
  double tolerance = 0;  ///< every physical number is off by, relative, one standard deviation
  std::uint64_t seed = 1;
  std::vector<std::string> only;     ///< types to hide; empty: all
  std::vector<std::string> without;  ///< signals that are not recorded: tension, current, joint
};
int blind_make(const BlindMakeOptions& options, std::ostream& out, std::ostream& remarks);

struct BlindRunOptions {
  std::string folder;
  int threads = 2;
  bool free_run = false;  ///< each answer is also let run freely in the simulator
};

/// Diagnoses the cases that have no diagnosis yet; under mpirun each process its part of them.
int blind_run(const BlindRunOptions& options, std::ostream& out, std::ostream& remarks);

/// Opens the truth, checks its hash, prints rates and every failure. Returns 0, or 5 if
/// cases have no diagnosis. Throws std::invalid_argument if the hash differs.
int blind_score(const std::string& folder, const std::string& truth, std::ostream& out);

}  // namespace launch::gap

#pragma once
#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

/// `erp gap blind`: makes cases with hidden effects, diagnoses them without the truth, and scores
/// the diagnoses.
///
///   DIR/robot.xml, DIR/cases.json    input of the diagnosis: the robot, the recordings of each
///   DIR/<case>/1.csv …               case, and the SHA-256 hash of the truth file
///   DIR/<case>/diagnosis.json        result of the diagnosis
///   TRUTH                            the hidden effects, in a separate file
namespace launch::gap {

struct BlindMakeOptions {
  std::string robot, out, truth, kind = "single";
  int cases = 10, recordings = 4, threads = 2;
  double seconds = 10;
  double tolerance = 0;  ///< relative standard deviation of the error of every physical constant
  std::uint64_t seed = 1;
  std::vector<std::string> only;     ///< effect types that may be hidden; empty: all
  std::vector<std::string> without;  ///< signals to omit: tension, current, joint
};
/// Writes the robot, the recordings and cases.json to `out`, and the hidden effects to `truth`.
/// Returns 0. Throws std::invalid_argument if no case can be made from the robot, or if files would
/// be overwritten.
int blind_make(const BlindMakeOptions& options, std::ostream& out, std::ostream& remarks);

struct BlindRunOptions {
  std::string folder;
  int threads = 2;
  bool free_run = false;  ///< also simulates each diagnosis as a free run
};

/// Diagnoses the cases that have no diagnosis.json yet; under mpirun each process takes a part of
/// them.
int blind_run(const BlindRunOptions& options, std::ostream& out, std::ostream& remarks);

/// Checks the hash of the truth file and prints success rates and every failed case. Returns 0, or
/// 5 if some cases have no diagnosis. Throws std::invalid_argument if the hash differs.
int blind_score(const std::string& folder, const std::string& truth, std::ostream& out);

}  // namespace launch::gap

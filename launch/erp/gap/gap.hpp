#pragma once
#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

#include "interfaces/robot/robot.hpp"
#include "sim/gap/residuals/episode.hpp"

/// `erp gap`: where recordings differ from a robot's model, which effect causes it, and how much of
/// the gap it closes.
namespace launch::gap {

/// Reads the robot and converts its drives to actuator chains. Throws xml::Errors.
erp::Robot read_chains(const std::string& robot_file);

/// Recordings aligned with a robot. `corrections`: messages about corrections that were made.
/// `suspicious`: messages about columns that the user must fix (wrong sign or unit, constant,
/// exchanged).
struct Reading {
  std::vector<sim::residuals::Episode> episodes;
  std::vector<std::string> corrections, suspicious;
};
/// Throws RecordingError and std::invalid_argument, the latter also if two recordings contain the
/// same values: a copy cannot validate a fit to the original.
Reading read_episodes(const erp::Robot& robot, const std::vector<std::string>& recordings);
/// Whether any recording is long enough to evaluate a stage.
bool can_evaluate(const std::vector<sim::residuals::Episode>& episodes);
inline constexpr const char* nothing_evaluated =
    "no stage could be evaluated; record a few seconds in which all actuators move\n";
/// Prints one message per line.
void print_lines(const std::vector<std::string>& messages, std::ostream& remarks);
/// Prints the suspicious columns. No other result is reliable until they are fixed.
void print_suspicious(const Reading& read, std::ostream& remarks);

/// Throws std::invalid_argument if a type is not in the effect library.
void check_withheld(const std::vector<std::string>& types);

/// Prints one row per stage, sorted by their share of the gap, and a summary of the stages with a
/// gap. Prints corrections of the recordings to `remarks`. Throws xml::Errors, RecordingError,
/// std::invalid_argument. Returns 0, or 5 if no stage could be evaluated.
int where(const std::string& robot_file, const std::vector<std::string>& recordings,
          std::ostream& out, std::ostream& remarks);

struct DiagnoseOptions {
  std::string robot, out;  ///< out: folder, created if missing; empty: no files
  std::vector<std::string> recordings, train, held_out, withhold;
  int threads = 2;
  bool free_run = true;  ///< also simulates the answer as a free run
  std::uint64_t seed = 1;
};

/// Prints location, cause and gap closure, and writes diagnosis.json, report.html and, if
/// supported, robot.xml. Throws the same exceptions as `where`. Returns 0: supported, 3: no gap, 4:
/// none of the known effects, 5: not identifiable.
int diagnose(const DiagnoseOptions& options, std::ostream& out, std::ostream& remarks);

struct CalibrateOptions {
  std::string robot, out;  ///< out: file; empty: no file
  std::vector<std::string> recordings;
  int threads = 2;
  std::uint64_t seed = 1;
};

/// Estimates all constants of a robot jointly, prints one row per constant (nominal, estimated, 95
/// % interval) and writes a robot.xml with the estimates. Throws the same exceptions as `where`,
/// and std::invalid_argument for a robot with drives. Returns 0, or 5 if no stage could be
/// evaluated.
int calibrate(const CalibrateOptions& options, std::ostream& out, std::ostream& remarks);

struct IndistinguishableOptions {
  std::string robot;
  std::vector<std::string> recordings = {};  ///< empty: four simulated recordings
  std::vector<std::string> without = {};     ///< signals to ignore: "tension", "current", "joint"
  double seconds = 20;                       ///< length of each simulated recording
  double share = 0.1;                        ///< largest share of the hidden effect that may remain
  int max_effects = 1;                     ///< largest number of effects that together replace one
  std::vector<std::string> withhold = {};  ///< effect types to exclude
  int threads = 2;
};

/// `erp gap confounders`. Prints the effects that the robot's sensors cannot distinguish, one row
/// per pair. With `max_effects` above 1, prints one row per effect, with the sum of other effects
/// that replaces it. Throws the same exceptions as `where`, and std::runtime_error. Returns 0, or 5
/// if no stage could be evaluated.
int list_indistinguishable(const IndistinguishableOptions& options, std::ostream& out,
                           std::ostream& remarks);

struct PlanOptions {
  std::string robot, diagnosis, out;  ///< diagnosis.json; out: folder, created if missing
  double seconds = 20;
  int candidates = 24, threads = 2;
  std::uint64_t seed = 1;
  double to_stop_rad = 0.05;  ///< smallest distance of hinges from their stops
};

/// Searches the excitation that best distinguishes the equivalent effects of a diagnosis, and
/// writes it as a graph for `erp launch`: graph.xml, reference.xml, trajectory.csv. Throws
/// xml::Errors, std::invalid_argument. Returns 0: written; 1: there is nothing to distinguish, or
/// no excitation is safe; 5: no excitation distinguishes the effects.
int plan(const PlanOptions& options, std::ostream& out, std::ostream& remarks);

}  // namespace launch::gap

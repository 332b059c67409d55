#pragma once
#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

#include "interfaces/robot/robot.hpp"
#include "sim/gap/residuals/episode.hpp"

/// `erp gap`: where recordings and a robot's model part, why, and by how much.
namespace launch::gap {

/// The robot, its drives as chains. Throws xml::Errors.
erp::Robot read_chains(const std::string& robot_file);

/// Recordings laid out for a robot, and in words what was mended, and what of signs and units a
/// person should mend.
struct Reading {
  std::vector<sim::residuals::Episode> episodes;
  std::vector<std::string> mended, odd;
};
/// Throws RecordingError, std::invalid_argument, also of a copy: it could not judge what was fitted to the other.
Reading read_episodes(const erp::Robot& robot, const std::vector<std::string>& recordings);
/// Whether any is long enough to judge something by.
bool can_judge(const std::vector<sim::residuals::Episode>& episodes);
inline constexpr const char* nothing_judged =
    "nothing could be judged; record some seconds in which everything moves\n";
/// Prints the corrections, a line each.
void tell(const std::vector<std::string>& list, std::ostream& remarks);
/// Prints the columns that look wrong; nothing else is reliable before they are mended.
void print_suspicious(const Reading& read, std::ostream& remarks);

/// Throws std::invalid_argument of a type that the library has not.
void check_withheld(const std::vector<std::string>& types);

/// Prints a row a stage, the largest share of the gap first, and the stages that leave their noise
/// floor in words; what was mended in the recordings goes to `remarks`. Throws xml::Errors,
/// RecordingError, std::invalid_argument. Returns the exit code.
int where(const std::string& robot_file, const std::vector<std::string>& recordings,
          std::ostream& out, std::ostream& remarks);

struct DiagnoseOptions {
  std::string robot, out;  ///< out: a folder, made if need be; empty: nothing is written
  std::vector<std::string> recordings, train, held_out, withhold;
  int threads = 2;
  bool free_run = true;  ///< the answer is also let run freely in the simulator
  std::uint64_t seed = 1;
};

/// Prints where, which and how far, and writes diagnosis.json, report.html and robot.xml. Throws as
/// `where`. Returns 0: supported, 3: no gap, 4: none of the known, 5: not identifiable.
int diagnose(const DiagnoseOptions& options, std::ostream& out, std::ostream& remarks);

struct CalibrateOptions {
  std::string robot, out;  ///< out: a file; empty: nothing is written
  std::vector<std::string> recordings;
  int threads = 2;
  std::uint64_t seed = 1;
};

/// Estimates all constants of a robot together and prints a row for each: nominal, found, 95 % interval;
/// writes the robot.xml of this robot. Throws as where; std::invalid_argument for a robot of drives.
/// Returns 0; 5: nothing could be judged.
int calibrate(const CalibrateOptions& options, std::ostream& out, std::ostream& remarks);

struct IndistinguishableOptions {
  std::string robot;
  std::vector<std::string> recordings = {};  ///< none: the simulator records four
  std::vector<std::string> without = {};     ///< "tension", "current", "joint": as if not recorded
  double seconds = 20;                       ///< of those that the simulator records
  double share = 0.1;                        ///< of what is hidden, at most left
  int together = 1;                          ///< so many that stand for one, at most
  std::vector<std::string> withhold = {};    ///< types of effects to do without
  int threads = 2;
};

/// Prints which effects the robot's sensors cannot tell apart, a row a pair; of several that stand
/// for one together, a row an effect. Throws as where, std::runtime_error. Returns 0; 5: nothing could be judged.
int twins(const IndistinguishableOptions& options, std::ostream& out, std::ostream& remarks);

struct PlanOptions {
  std::string robot, diagnosis, out;  ///< diagnosis.json; out: a folder, made if need be
  double seconds = 20;
  int candidates = 24, threads = 2;
  std::uint64_t seed = 1;
  double to_stop_rad = 0.05;  ///< hinges stay farther from their stops
};

/// Searches the excitation that best splits what a diagnosis could not tell apart, and writes it as
/// a graph to launch: graph.xml, reference.xml, trajectory.csv. Throws xml::Errors,
/// std::invalid_argument. Returns 0; 1: nothing to split, or none is safe; 5: none would split
/// them.
int plan(const PlanOptions& options, std::ostream& out, std::ostream& remarks);

}  // namespace launch::gap

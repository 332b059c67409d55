#pragma once
#include <catch2/catch.hpp>
#include <iostream>
#include <numbers>
#include <sstream>

#include "interfaces/recording/mcap_reader.hpp"
#include "interfaces/recording/table.hpp"
#include "launch/erp/record/joints.hpp"
#include "tests/stalls.hpp"
#include "tests/system/command.hpp"

/// Runs of graphs with joint control, and their joint errors.
namespace tests {

constexpr double degree = std::numbers::pi / 180;

inline std::string recording_in(const std::string& folder) {
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".mcap") return entry.path().string();
  FAIL("no recording");
  return {};
}

/// Runs a graph in lockstep for `for_s` of simulated time. Returns the recording file.
inline std::string recorded(const Folder& folder, const std::string& graph, int for_s = 29) {
  const auto outcome = run("erp launch " + graph + " --lockstep --for " + std::to_string(for_s) +
                           "s --out " + (folder / "run"));
  INFO(outcome.output);
  REQUIRE(outcome.exit_code == 0);
  return recording_in(folder / "run");
}

inline std::vector<launch::JointError> errors(const std::string& file, const std::string& source,
                                              const std::string& against, double from_s = 0.5) {
  const recording::McapReader reader(file);
  auto errors_of_joints = launch::joint_errors(recording::joint_tracks(reader, source),
                                               recording::joint_tracks(reader, against), from_s);
  REQUIRE(errors_of_joints.size() > 0);
  for (const auto& e : errors_of_joints) REQUIRE(e.frames > 500);
  return errors_of_joints;
}

/// A graph of each joint controller.
struct JointRun {
  std::string graph;
  int for_s;
  double allowed_deg;  ///< RMS error of each joint
};

inline JointRun joint_run() {
  return GENERATE(JointRun{"puller_follower", 12, 0.5}, JointRun{"puller_follower_twin", 5, 1.5},
                  JointRun{"puller_follower_seven", 12, 1}, JointRun{"computed_force", 29, 0.5},
                  JointRun{"computed_force_estimated", 29, 1.5});
}

/// Prints the error of each joint. Returns a finding for each joint with an RMS error of
/// `allowed_deg` or more.
inline Findings error_findings(const std::string& run, const std::string& recording, double from_s,
                               double allowed_deg) {
  Findings findings;
  for (const auto& e : errors(recording, "sim", "joint_target", from_s)) {
    std::ostringstream message;
    message << run << ": " << e.joint << " " << e.rms_rad / degree << "° RMS, "
            << e.largest_rad / degree << "° at most from " << from_s << " s on";
    std::cout << message.str() << std::endl;
    if (!(e.rms_rad < allowed_deg * degree))
      findings.push_back(message.str() + ", allowed " + std::to_string(allowed_deg));
  }
  return findings;
}

inline double smallest_tension_N(const std::string& file) {
  const auto table = recording::read_table(file);
  double smallest_N = 1e9;
  for (const auto& name : table.owners("tension_N"))
    for (const double f : table.find(name + ".tension_N")->values)
      smallest_N = std::min(smallest_N, f);
  return smallest_N;
}

}  // namespace tests

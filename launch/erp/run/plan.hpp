#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "interfaces/graph/graph.hpp"
#include "launch/erp/run/back_off.hpp"

/// From a graph to the processes that make it up. Pure: no file, no process.
namespace launch {

/// `--set component.key=value`.
struct Setting {
  std::string component, key, value;
};
/// Throws std::invalid_argument unless the text reads component.key=value.
Setting parse_setting(const std::string& text);

/// `sim`, `can`, or `replay:FILE`; what it says goes into the graph. Throws std::invalid_argument.
void choose_device(erp::Graph& graph, const std::string& text);

/// What the command line adds to the graph file.
struct Wishes {
  std::vector<Setting> settings;
  std::string folder;               ///< of the run: logs and recording
  std::vector<std::string> attach;  ///< XML files for the logger to keep with the recording
};

/// The order in which components become active; the device comes last.
enum class Role { logger, plant, controller, robot_behind_bus, device };

struct PlannedProcess {
  std::string name, type;
  Role role = Role::controller;
  erp::Restart restart = erp::Restart::on_failure;
  std::vector<std::string> argv;
  std::string log_file;
};

/// Every process, in the order of activation.
struct Plan {
  std::vector<PlannedProcess> processes;
  std::string recording;  ///< what the first logger writes; empty: no logger
  std::size_t most_restarts = BackOff::Tuning{}.most;  ///< of one component within 30 s
  double patience_s = 60;                              ///< until all components are ready
};

/// The program of a component type, or "".
using FindProgram = std::function<std::string(const std::string& type)>;

/// The plant, the device and, behind a CAN bus without hardware, the simulator are added to the
/// components that the graph names; lines of the same name configure them.
/// Throws std::invalid_argument, with a remedy, for what cannot be started: an unknown program, a
/// setting for a component that is not there, lockstep with hardware.
Plan make_plan(const erp::Graph& graph, const Wishes& wishes, const FindProgram& find_program);

}  // namespace launch

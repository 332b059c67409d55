#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "interfaces/graph/graph.hpp"
#include "launch/erp/run/back_off.hpp"

/// The processes of a graph with their command lines. Reads no file and starts no process.
namespace launch {

/// `--set component.key=value`.
struct Setting {
  std::string component, key, value;
};
/// Parses component.key=value. Throws std::invalid_argument for other texts.
Setting parse_setting(const std::string& text);

/// The program of a component.
std::string type_of(const erp::GraphComponent& component);

/// Sets the device of the graph from `sim`, `can` or `replay:FILE`. Throws std::invalid_argument
/// for other texts.
void choose_device(erp::Graph& graph, const std::string& text);

/// Options of a run that are not in the graph file.
struct RunOptions {
  std::vector<Setting> settings;
  std::string folder;               ///< of the run: logs and recording
  std::vector<std::string> attach;  ///< XML files that the logger attaches to the recording
};

/// Roles in the order of activation; the device is last.
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
  std::string recording;            ///< file of the first logger; empty: no logger
  std::vector<std::string> inputs;  ///< XML files that the components read
  /// Command that is run when all components are active; empty: none.
  std::vector<std::string> when_active;
  std::size_t max_restarts = BackOff::Tuning{}.max_restarts;  ///< of one component within 30 s
  double ready_timeout_s = 60;  ///< time limit until all components are ready
};

/// Returns the program of a component type, or "".
using FindProgram = std::function<std::string(const std::string& type)>;

/// Adds to the components of the graph: the plant, the device and, behind a CAN bus without
/// hardware, the simulator. A <component> of the graph with one of these names configures it.
/// Throws std::invalid_argument with a remedy for an unknown program, a setting of a component that
/// does not exist, and lockstep with hardware.
Plan make_plan(const erp::Graph& graph, const RunOptions& options, const FindProgram& find_program);

}  // namespace launch

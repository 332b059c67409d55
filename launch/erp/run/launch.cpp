#include "launch/erp/run/launch.hpp"

#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <set>

#include "components/node/clock.hpp"
#include "components/node/security.hpp"
#include "interfaces/robot/robot.hpp"
#include "launch/erp/record/summary.hpp"
#include "launch/erp/run/input_sources.hpp"
#include "launch/erp/run/plan.hpp"
#include "launch/erp/run/program.hpp"
#include "launch/erp/run/run.hpp"
#include "launch/erp/run/run_folder.hpp"
#include "launch/erp/text/duration.hpp"
#include "launch/erp/verbs/component_check.hpp"

namespace launch {
namespace fs = std::filesystem;
namespace {

erp::Graph graph_of(const LaunchOptions& options) {
  erp::Graph graph = erp::read_graph(options.graph_file);
  if (!options.device.empty()) choose_device(graph, options.device);
  if (options.time) graph.time = *options.time;
  if (!options.duration.empty()) graph.duration_s = parse_duration_s(options.duration);
  return graph;
}

/// Every XML file that defines this run, including the parts of the robot.
std::vector<std::string> sources(const erp::Graph& graph, const erp::Robot& robot) {
  std::set<std::string> files{graph.place.file, graph.robot};
  const auto add = [&files](const auto& items) {
    for (const auto& item : items) files.insert(item.place.file);
  };
  add(robot.skeletons), add(robot.motor_types), add(robot.sensor_types);
  add(robot.actuators), add(robot.joint_sensors), add(robot.potentiometers), add(robot.imus);
  for (const auto& component : graph.components) files.insert(component.config);
  std::set<std::string> unique;
  for (const auto& file : files)
    if (!file.empty()) unique.insert(fs::weakly_canonical(file).string());
  return {unique.begin(), unique.end()};
}

/// Checks configs and settings with the programs of the components before any of them starts.
/// Throws std::invalid_argument with all errors.
void check_components(const Plan& plan) {
  std::string errors;
  for (const auto& process : plan.processes) {
    const std::string component_errors = check_component(process.argv);
    if (!component_errors.empty())
      errors += (errors.empty() ? "" : "\n") + process.name + ": " + component_errors;
  }
  while (errors.ends_with('\n')) errors.pop_back();
  if (!errors.empty()) throw std::invalid_argument(errors);
}

/// The recordings of the run, oldest first. A restarted logger renames the earlier part to
/// NAME.k.mcap.
std::vector<std::string> parts_of(const std::string& recording, fs::file_time_type start_time) {
  std::vector<std::string> parts;
  std::error_code ignored;
  const auto is_of_this_run = [&](const fs::path& path) {
    return fs::exists(path, ignored) && fs::file_size(path, ignored) > 0 &&
           fs::last_write_time(path, ignored) >= start_time;
  };
  const fs::path last(recording);
  for (int k = 1;; ++k) {
    auto part = last;
    part.replace_extension("." + std::to_string(k) + last.extension().string());
    if (!fs::exists(part, ignored)) break;
    if (is_of_this_run(part)) parts.push_back(part.string());
  }
  if (is_of_this_run(last)) parts.push_back(recording);
  return parts;
}

/// Enables DDS Security for this process and its children. Rejects an invalid folder before any
/// process starts.
void set_security(const std::optional<std::string>& folder) {
  if (folder) setenv("ERP_SECURITY", folder->empty() ? "" : fs::absolute(*folder).c_str(), 1);
  node::security_config();
}

}  // namespace

int launch_graph(const LaunchOptions& options) {
  set_security(options.security);
  const erp::Graph graph = graph_of(options);
  const erp::Robot robot = erp::read_robot(graph.robot);
  if (!robot.drives.empty())
    throw std::invalid_argument(graph.robot + ": drive \"" + robot.drives[0].name +
                                "\" cannot run in a graph, where ECUs move tendons; use its "
                                "recordings with erp gap diagnose");
  const std::string graph_folder = fs::absolute(options.graph_file).parent_path().string();
  const auto find = [&](const std::string& type) { return find_program(type, graph_folder); };

  const double ready_timeout_s = parse_duration_s(options.ready_timeout);
  RunOptions run_options{{}, ".", sources(graph, robot)};
  for (const auto& setting : options.settings)
    run_options.settings.push_back(parse_setting(setting));
  check_input_sources(graph, run_options.settings);
  check_components(make_plan(graph, run_options, find));  // before the folder is created
  run_options.folder = make_run_folder(options.folder, graph.name, node::wall_ns());
  const FolderLock lock(run_options.folder);
  Plan plan = make_plan(graph, run_options, find);
  plan.max_restarts = options.max_restarts;
  plan.ready_timeout_s = ready_timeout_s;
  plan.inputs = run_options.attach;
  if (robot.homing == erp::Homing::at_start)
    plan.when_active = {
        fs::read_symlink("/proc/self/exe"), "home", "--robot", robot.name, "--xml", graph.robot};
  const auto start_time = fs::file_time_type::clock::now();
  Run run(graph, robot.name, plan, run_options.folder);
  const int exit_code = run.execute();
  const auto parts = parts_of(plan.recording, start_time);
  if (!parts.empty()) print_summary({parts, robot, run.active_s()}, std::cout);
  return exit_code;
}

}  // namespace launch

#include "launch/erp/launch.hpp"

#include <filesystem>
#include <iostream>
#include <set>

#include "components/node/clock.hpp"
#include "interfaces/robot/robot.hpp"
#include "launch/erp/duration.hpp"
#include "launch/erp/plan.hpp"
#include "launch/erp/program.hpp"
#include "launch/erp/run.hpp"
#include "launch/erp/run_folder.hpp"
#include "launch/erp/summary.hpp"

namespace launch {
namespace {

erp::Graph graph_of(const LaunchOptions& options) {
  erp::Graph graph = erp::read_graph(options.graph_file);
  if (!options.device.empty()) choose_device(graph, options.device);
  if (options.time) graph.time = *options.time;
  if (!options.duration.empty()) graph.duration_s = parse_duration_s(options.duration);
  return graph;
}

/// Every XML file that makes this run what it is, parts of the robot included.
std::vector<std::string> sources(const erp::Graph& graph, const erp::Robot& robot) {
  std::set<std::string> files{graph.place.file, graph.robot};
  const auto add = [&files](const auto& items) {
    for (const auto& item : items) files.insert(item.place.file);
  };
  add(robot.skeletons), add(robot.motor_types), add(robot.sensor_types);
  add(robot.actuators), add(robot.joint_sensors);
  for (const auto& component : graph.components) files.insert(component.config);
  std::set<std::string> unique;
  for (const auto& file : files)
    if (!file.empty()) unique.insert(std::filesystem::weakly_canonical(file).string());
  return {unique.begin(), unique.end()};
}

}  // namespace

int launch_graph(const LaunchOptions& options) {
  const erp::Graph graph = graph_of(options);
  const erp::Robot robot = erp::read_robot(graph.robot);
  const std::string graph_folder =
      std::filesystem::absolute(options.graph_file).parent_path().string();
  const auto find = [&](const std::string& type) { return find_program(type, graph_folder); };

  Wishes wishes{{}, ".", sources(graph, robot)};
  for (const auto& setting : options.settings) wishes.settings.push_back(parse_setting(setting));
  make_plan(graph, wishes, find);  // refuses bad input before a folder is made
  wishes.folder = make_run_folder(options.folder, graph.name, node::wall_ns());
  const Plan plan = make_plan(graph, wishes, find);
  const int exit_code = Run(graph, robot.name, plan, wishes.folder).execute();
  if (std::filesystem::exists(plan.recording)) print_summary(plan.recording, std::cout);
  return exit_code;
}

}  // namespace launch

#include "launch/erp/run/plan.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "hal/can/bus.hpp"
#include "interfaces/xml/errors.hpp"
#include "interfaces/xml/words.hpp"
#include "launch/erp/run/program.hpp"

namespace launch {
namespace {

const char* name_of(erp::Time time) {
  for (const auto& [name, value] : xml::Names<erp::Time>::list)
    if (value == time) return name;
  return "";
}

const char* device_type(erp::Device device) {
  switch (device) {
    case erp::Device::sim:
      return "sim";
    case erp::Device::can:
      return "gateway";
    case erp::Device::replay:
      break;
  }
  return "replay";
}

bool is_device_type(const std::string& type) {
  return type == "sim" || type == "gateway" || type == "replay";
}

std::string bus_of(const erp::Graph& graph) {
  return graph.bus != erp::Graph{}.bus ? graph.bus : erp::default_bus();
}

bool needs_robot_behind_bus(const erp::Graph& graph) {
  return graph.device == erp::Device::can && !graph.hardware;
}

/// The <component> of the graph for a component that the launcher adds, or a default without
/// config. The default restarts the plant whenever it ends, because no actuator moves without it.
erp::GraphComponent component_for(const erp::Graph& graph, const std::string& type) {
  for (const auto& component : graph.components)
    if (component.name == type) return component;
  erp::GraphComponent implicit;
  implicit.name = type;
  if (type == "plant") implicit.restart = erp::Restart::always;
  return implicit;
}

void check_graph(const erp::Graph& graph) {
  if (graph.hardware && graph.device == erp::Device::can && graph.time == erp::Time::lockstep)
    throw std::invalid_argument(
        "a real robot cannot run in lockstep; use --realtime, or hardware=\"false\"");
  if (graph.device == erp::Device::replay && graph.replay.empty())
    throw std::invalid_argument("device replay without a recording; use --device replay:FILE");
}

std::vector<std::string> settings_of(const erp::Graph& graph, const RunOptions& options,
                                     const PlannedProcess& process) {
  std::vector<std::string> settings;
  if (process.type == "gateway" || process.role == Role::robot_behind_bus)
    settings.push_back("bus=" + bus_of(graph));
  if (process.type == "replay") settings.push_back("file=" + graph.replay);
  if (process.role == Role::logger) {
    const auto& stem = process.name == "logger" ? graph.name : process.name;
    settings.push_back("file=" + options.folder + "/" + stem + ".mcap");
    settings.push_back("attach=" + xml::joined(options.attach, ":"));
  }
  // settings of the command line override the others
  for (const auto& setting : options.settings) {
    if (setting.component != process.name) continue;
    std::erase_if(settings,
                  [&](const auto& other) { return other.starts_with(setting.key + "="); });
    settings.push_back(setting.key + "=" + setting.value);
  }
  return settings;
}

std::string parameter_text(double value) {
  std::ostringstream text;
  text.precision(12);
  text << value;
  return text.str();
}

void fill_command_line(PlannedProcess& process, const erp::Graph& graph, const RunOptions& options,
                       const std::string& config) {
  auto& argv = process.argv;
  const auto add = [&argv](const char* option, const std::string& value) {
    argv.insert(argv.end(), {option, value});
  };
  add("--name", process.name);
  add("--robot", graph.robot);
  if (!config.empty()) add("--config", config);
  add("--time", name_of(graph.time));
  // In lockstep the device counts the ticks of the run. Otherwise the launcher ends the run by its
  // own clock.
  if (process.role == Role::device && graph.duration_s > 0 && graph.time == erp::Time::lockstep)
    add("--duration", parameter_text(graph.duration_s));
  for (const auto& setting : settings_of(graph, options, process)) add("--set", setting);
  argv.push_back("--managed");
}

void check_settings(const Plan& plan, const RunOptions& options) {
  std::vector<std::string> names;
  for (const auto& process : plan.processes) names.push_back(process.name);
  for (const auto& setting : options.settings)
    if (std::find(names.begin(), names.end(), setting.component) == names.end())
      throw std::invalid_argument("--set " + setting.component + "." + setting.key +
                                  ": no such component in this run; " +
                                  xml::did_you_mean(setting.component, names));
}

/// Reports a missing program. A component that the launcher adds, such as the device, has no place
/// in a file.
[[noreturn]] void throw_missing(const erp::GraphComponent& component, const std::string& type) {
  const std::string what = "component \"" + component.name + "\": no program \"" + type +
                           "\" beside erp, in $ERP_COMPONENT_PATH or in $PATH";
  const std::string remedy = xml::did_you_mean(type, own_programs());
  if (component.place.file.empty()) throw std::invalid_argument(what + "; " + remedy);
  throw xml::Errors({xml::error_in(erp::GraphComponent::element, component.place, what, remedy)});
}

std::string recording_of(const PlannedProcess& logger) {
  constexpr std::string_view file_setting = "file=";
  for (const auto& argument : logger.argv)
    if (argument.starts_with(file_setting)) return argument.substr(file_setting.size());
  return "";
}

}  // namespace

std::string type_of(const erp::GraphComponent& component) {
  return component.type.empty() ? component.name : component.type;
}

Setting parse_setting(const std::string& text) {
  const auto equals = text.find('=');
  const auto dot = text.find('.');
  if (equals == text.npos || dot == text.npos || dot == 0 || equals <= dot + 1)
    throw std::invalid_argument("--set " + text + ": expected component.key=value");
  return {text.substr(0, dot), text.substr(dot + 1, equals - dot - 1), text.substr(equals + 1)};
}

void choose_device(erp::Graph& graph, const std::string& text) {
  constexpr std::string_view replay = "replay:";
  if (text.starts_with(replay) && text.size() > replay.size()) {
    graph.device = erp::Device::replay;
    graph.replay = text.substr(replay.size());
  } else if (text == "sim") {
    graph.device = erp::Device::sim;
  } else if (text == "can") {
    graph.device = erp::Device::can;
  } else {
    throw std::invalid_argument("--device " + text + ": expected sim, can or replay:FILE");
  }
}

Plan make_plan(const erp::Graph& graph, const RunOptions& options,
               const FindProgram& find_program) {
  check_graph(graph);
  Plan plan;
  const auto add = [&](const erp::GraphComponent& component, Role role) {
    PlannedProcess process{component.name, type_of(component), role, component.restart, {}, {}};
    const std::string program = find_program(process.type);
    if (program.empty()) throw_missing(component, process.type);
    process.argv.push_back(program);
    process.log_file = options.folder + "/" + process.name + ".log";
    fill_command_line(process, graph, options, component.config);
    plan.processes.push_back(std::move(process));
  };
  for (const auto& component : graph.components)
    if (type_of(component) == "logger") add(component, Role::logger);
  add(component_for(graph, "plant"), Role::plant);
  for (const auto& component : graph.components)
    if (type_of(component) != "logger" && component.name != "plant" &&
        !is_device_type(component.name))
      add(component, Role::controller);
  if (needs_robot_behind_bus(graph)) add(component_for(graph, "sim"), Role::robot_behind_bus);
  add(component_for(graph, device_type(graph.device)), Role::device);
  check_settings(plan, options);
  if (plan.processes.front().role == Role::logger)
    plan.recording = recording_of(plan.processes.front());
  return plan;
}

}  // namespace launch

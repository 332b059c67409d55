#include "launch/erp/run/plan.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <stdexcept>

using Catch::Matchers::Contains;
using Strings = std::vector<std::string>;

namespace {

erp::Graph rig() {
  erp::Graph graph;
  graph.name = "rig";
  graph.robot = "/r/robot.xml";
  erp::GraphComponent control, logger;
  control.name = "force_control";
  control.config = "/r/force_control.xml";
  logger.name = "logger";
  graph.components = {control, logger};
  return graph;
}

std::string in_bin(const std::string& type) { return "/bin/" + type; }

launch::Plan plan_of(const erp::Graph& graph,
                     const launch::RunOptions& options = {{}, "/run", {}}) {
  return launch::make_plan(graph, options, in_bin);
}

Strings names(const launch::Plan& plan) {
  Strings list;
  for (const auto& process : plan.processes) list.push_back(process.name);
  return list;
}

/// The values that follow an option on a component's command line.
Strings values(const launch::Plan& plan, const std::string& name, const std::string& option) {
  Strings found;
  for (const auto& process : plan.processes)
    for (std::size_t i = 0; process.name == name && i + 1 < process.argv.size(); ++i)
      if (process.argv[i] == option) found.push_back(process.argv[i + 1]);
  return found;
}

}  // namespace

TEST_CASE("processes are in the order logger, plant, controllers, device") {
  CHECK(names(plan_of(rig())) == Strings{"logger", "plant", "force_control", "sim"});
}

TEST_CASE("--device exchanges the device processes") {
  unsetenv("ERP_DOMAIN");  // a domain in the environment would change the port
  auto graph = rig();
  launch::choose_device(graph, "can");
  CHECK(names(plan_of(graph)) == Strings{"logger", "plant", "force_control", "sim", "gateway"});
  CHECK(values(plan_of(graph), "sim", "--set") == Strings{"bus=" + graph.bus});
  CHECK(values(plan_of(graph), "gateway", "--set") == Strings{"bus=" + graph.bus});

  graph.hardware = true;
  CHECK(names(plan_of(graph)) == Strings{"logger", "plant", "force_control", "gateway"});

  launch::choose_device(graph, "replay:/tmp/a b.mcap");
  CHECK(names(plan_of(graph)) == Strings{"logger", "plant", "force_control", "replay"});
  CHECK(values(plan_of(graph), "replay", "--set") == Strings{"file=/tmp/a b.mcap"});
}

TEST_CASE("the command line of each component has name, robot, config, time and --managed") {
  auto graph = rig();
  graph.time = erp::Time::lockstep;
  const auto plan = plan_of(graph);
  for (const auto& process : plan.processes) {
    CHECK(process.argv.front() == "/bin/" + process.type);
    CHECK(process.argv.back() == "--managed");
    CHECK(values(plan, process.name, "--name") == Strings{process.name});
    CHECK(values(plan, process.name, "--robot") == Strings{"/r/robot.xml"});
    CHECK(values(plan, process.name, "--time") == Strings{"lockstep"});
    CHECK(process.log_file == "/run/" + process.name + ".log");
  }
  CHECK(values(plan, "force_control", "--config") == Strings{"/r/force_control.xml"});
  CHECK(values(plan, "plant", "--config").empty());
}

TEST_CASE("in lockstep only the device gets --duration") {
  auto graph = rig();
  graph.duration_s = 0.5;
  graph.time = erp::Time::lockstep;
  const auto plan = plan_of(graph);
  CHECK(values(plan, "sim", "--duration") == Strings{"0.5"});
  CHECK(values(plan, "plant", "--duration").empty());
  CHECK(plan.processes.back().role == launch::Role::device);
}

TEST_CASE("in real time no component gets --duration") {
  auto graph = rig();
  graph.duration_s = 0.5;
  CHECK(values(plan_of(graph), "sim", "--duration").empty());
}

TEST_CASE("a line for plant or simulator configures it and adds no second process") {
  auto graph = rig();
  erp::GraphComponent plant, sim;
  plant.name = "plant", plant.config = "/r/plant.xml", plant.restart = erp::Restart::never;
  sim.name = "sim", sim.config = "/r/sim.xml";
  graph.components.insert(graph.components.begin(), {sim, plant});
  const auto plan = plan_of(graph);
  CHECK(names(plan) == Strings{"logger", "plant", "force_control", "sim"});
  CHECK(values(plan, "plant", "--config") == Strings{"/r/plant.xml"});
  CHECK(values(plan, "sim", "--config") == Strings{"/r/sim.xml"});
  CHECK(plan.processes[1].restart == erp::Restart::never);
}

TEST_CASE("a plant without a line in the graph has restart=always") {
  CHECK(plan_of(rig()).processes[1].restart == erp::Restart::always);
}

TEST_CASE("the logger writes into the run folder unless --set logger.file gives a path") {
  launch::RunOptions options{{}, "/run", {"/r/robot.xml", "/r/graph.xml"}};
  CHECK(values(plan_of(rig(), options), "logger", "--set") ==
        Strings{"file=/run/rig.mcap", "attach=/r/robot.xml:/r/graph.xml"});
  CHECK(plan_of(rig(), options).recording == "/run/rig.mcap");

  options.settings = {launch::parse_setting("logger.file=/tmp/mine=1.mcap")};
  CHECK(values(plan_of(rig(), options), "logger", "--set") ==
        Strings{"attach=/r/robot.xml:/r/graph.xml", "file=/tmp/mine=1.mcap"});
  CHECK(plan_of(rig(), options).recording == "/tmp/mine=1.mcap");
}

TEST_CASE("a setting is passed to its component only") {
  launch::RunOptions options{{launch::parse_setting("force_control.gain=2")}, "/run", {}};
  const auto plan = plan_of(rig(), options);
  CHECK(values(plan, "force_control", "--set") == Strings{"gain=2"});
  CHECK(values(plan, "plant", "--set").empty());
}

TEST_CASE("a setting of an unknown component is rejected with the most similar name") {
  launch::RunOptions options{{launch::parse_setting("force_contol.gain=2")}, "/run", {}};
  CHECK_THROWS_WITH(plan_of(rig(), options), Contains("did you mean \"force_control\"?"));
}

TEST_CASE("a setting that does not read component.key=value is rejected with the expected form") {
  for (const char* text : {"", "gain", "gain=2", ".gain=2", "a.=2", "a=b.c"}) {
    INFO(text);
    CHECK_THROWS_WITH(launch::parse_setting(text), Contains("expected component.key=value"));
  }
}

TEST_CASE("a component without a program is rejected with the search path") {
  CHECK_THROWS_WITH(
      launch::make_plan(rig(), {{}, "/run", {}},
                        [](const std::string& type) { return type == "sim" ? "" : "/bin/x"; }),
      Contains("component \"sim\"") && Contains("$ERP_COMPONENT_PATH"));
}

TEST_CASE("lockstep with hardware is rejected") {
  auto graph = rig();
  graph.device = erp::Device::can, graph.hardware = true, graph.time = erp::Time::lockstep;
  CHECK_THROWS_WITH(plan_of(graph), Contains("lockstep"));
}

TEST_CASE("an unknown device is rejected with the known ones") {
  auto graph = rig();
  for (const char* text : {"", "cam", "replay", "replay:"}) {
    INFO(text);
    CHECK_THROWS_WITH(launch::choose_device(graph, text), Contains("sim, can or replay:FILE"));
  }
}

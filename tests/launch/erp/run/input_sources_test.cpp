#include "launch/erp/run/input_sources.hpp"

#include <catch2/catch.hpp>

#include "interfaces/xml/errors.hpp"

namespace {

/// A graph on hardware with components of these names.
erp::Graph on_hardware(const std::vector<std::string>& names) {
  erp::Graph graph;
  graph.device = erp::Device::can, graph.hardware = true;
  for (const auto& name : names) {
    erp::GraphComponent component;
    component.name = name;
    graph.components.push_back(component);
  }
  return graph;
}

std::string error_of(const erp::Graph& graph, const std::vector<launch::Setting>& settings = {}) {
  try {
    launch::check_input_sources(graph, settings);
    return "";
  } catch (const xml::Errors& errors) {
    return errors.what();
  }
}

}  // namespace

TEST_CASE("on hardware a controller of the simulator's joint angles is refused with a remedy") {
  for (const std::string name :
       {"computed_force", "puller_follower", "experience", "joint_target"}) {
    const auto error = error_of(on_hardware({name}));
    CHECK(error.find("component \"" + name + "\" gets its joint angles from the simulator") !=
          error.npos);
    CHECK(error.find("pose_estimator") != error.npos);
  }
  CHECK(error_of(on_hardware({"synergy"})).find("body poses") != std::string::npos);
  CHECK(error_of(on_hardware({"eye"})).find("set images") != std::string::npos);
}

TEST_CASE("a source that runs in the graph is accepted, another one is not") {
  const std::vector<launch::Setting> settings{{"computed_force", "source", "pose_estimator"}};
  CHECK(error_of(on_hardware({"computed_force", "pose_estimator"}), settings).empty());
  CHECK(error_of(on_hardware({"computed_force"}), settings).find("from \"pose_estimator\"") !=
        std::string::npos);
}

TEST_CASE("with a simulator behind the bus every source is available") {
  erp::Graph graph = on_hardware({"computed_force", "eye"});
  graph.hardware = false;
  CHECK(error_of(graph).empty());
}

TEST_CASE(
    "the shipped graph with estimated joint angles runs on hardware, the others name what is "
    "missing") {
  const auto graph_of = [](const std::string& name) {
    erp::Graph graph = erp::read_graph(std::string(ERP_SOURCE_DIR "/launch/") + name + ".xml");
    graph.device = erp::Device::can, graph.hardware = true;
    return graph;
  };
  CHECK(error_of(graph_of("hinge_rig")).empty());
  CHECK(error_of(graph_of("computed_force_estimated")).empty());
  CHECK(error_of(graph_of("computed_force")).find("joint angles from the simulator") !=
        std::string::npos);
}

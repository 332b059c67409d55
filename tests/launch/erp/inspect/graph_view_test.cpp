#include <catch2/catch.hpp>

#include "launch/erp/inspect/graph_view.hpp"

using Catch::Matchers::Contains;

namespace {

const std::vector<node::Endpoint> rig_graph{
    {"sensor_frame", "erp::SensorFrame", "plant", true, 0},
    {"sensor_frame", "erp::SensorFrame", "force_control", false, 0},
    {"sensor_frame", "erp::SensorFrame", "erp", false, 0},
    {"event", "erp::Event", "plant", true, 0},
    {"mine", "my::Type", "", true, 0},
};

}  // namespace

TEST_CASE("the topic table lists writers and readers") {
  const auto lines = launch::topic_table(rig_graph);
  REQUIRE(lines.size() == 4);
  CHECK_THAT(lines[3], Contains("sensor_frame") && Contains("erp::SensorFrame") &&
                           Contains("plant") && Contains("erp, force_control"));
}

TEST_CASE("a writer without a name is shown as ?, missing readers as -") {
  const auto lines = launch::topic_table(rig_graph);
  CHECK_THAT(lines[2], Contains("mine") && Contains("?") && Contains("-"));
}

TEST_CASE("the DOT graph omits topics of every component; the option all includes them") {
  const auto dot = launch::to_dot(rig_graph, false);
  CHECK_THAT(dot, Contains("\"plant\" -> \"/sensor_frame\"") &&
                      Contains("\"/sensor_frame\" -> \"force_control\"") && !Contains("event") &&
                      !Contains("-> \"erp\""));
  CHECK_THAT(launch::to_dot(rig_graph, true), Contains("\"plant\" -> \"/event\""));
}

TEST_CASE("quotes in a name are escaped in DOT") {
  const auto dot = launch::to_dot({{"t", "T", "a\"; evil", true, 0}}, false);
  CHECK_THAT(dot, Contains("\"a\\\"; evil\""));
}

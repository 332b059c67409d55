// erp help and the XSD: every attribute and element of robot and graph files has a meaning.
#include "launch/erp/inspect/reference.hpp"

#include <catch2/catch.hpp>
#include <sstream>

#include "interfaces/graph/graph.hpp"
#include "interfaces/robot/robot.hpp"
#include "tests/interfaces/xml/without_description.hpp"

TEST_CASE("every element and attribute of robot.xml has a meaning") {
  CHECK(without_description<erp::Robot>("robot") == std::vector<std::string>{});
}

TEST_CASE("every element and attribute of a graph has a meaning") {
  CHECK(without_description<erp::Graph>("graph") == std::vector<std::string>{});
}

namespace {

/// No component has a program here, except `brake`.
std::optional<std::string> describe(const std::string& type) {
  if (type != "brake") return std::nullopt;
  return "force_N  number  N  default 3  Force of the brake.\n";
}

std::string reference(const std::string& name) {
  std::ostringstream out;
  launch::print_reference(name, describe, out);
  return out.str();
}

}  // namespace

TEST_CASE("erp help robot prints type, range, unit, default and meaning") {
  CHECK_THAT(reference("robot"), Catch::Contains("resistance_ohm") &&
                                     Catch::Contains("number > 0") && Catch::Contains("  ohm  ") &&
                                     Catch::Contains("required") && Catch::Contains("default"));
}

TEST_CASE("erp help of a file that a config names prints its attributes") {
  CHECK_THAT(reference("loops"), Catch::Contains("crossover_Hz") && Catch::Contains("  Hz  "));
}

TEST_CASE("erp help of a component prints the table of its program") {
  CHECK_THAT(reference("brake"), Catch::Contains("Force of the brake.") &&
                                     Catch::Contains("--set brake.PARAMETER=VALUE"));
}

TEST_CASE("erp help of an unknown name gives the most similar one") {
  CHECK_THROWS_WITH(reference("robt"), Catch::Contains("robot"));
  CHECK_THROWS_WITH(reference("puler_follower"), Catch::Contains("puller_follower"));
}

TEST_CASE("erp help without a name lists formats, components and files") {
  std::ostringstream out;
  launch::list_references(out);
  CHECK_THAT(out.str(), Catch::Contains("graph robot") && Catch::Contains("puller_follower") &&
                            Catch::Contains("loops"));
}

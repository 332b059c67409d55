// erp help and the XSD: every attribute and element of robot and graph files has a meaning.
#include "launch/erp/inspect/reference.hpp"

#include <catch2/catch.hpp>
#include <sstream>

#include "interfaces/graph/graph.hpp"
#include "interfaces/robot/robot.hpp"
#include "interfaces/xml/xml.hpp"

namespace {

template <class T>
std::vector<std::string> without_meaning() {
  std::vector<xml::Description> all;
  T fresh{};
  xml::Describer describer(all);
  fresh.visit(describer);
  std::vector<std::string> names;
  std::string element = T::element;
  for (const auto& d : all) {
    if (d.is_element) element = d.name;
    if (d.meaning.empty()) names.push_back(element + " " + d.name);
  }
  return names;
}

}  // namespace

TEST_CASE("every element and attribute of robot.xml has a meaning") {
  CHECK(without_meaning<erp::Robot>() == std::vector<std::string>{});
}

TEST_CASE("every element and attribute of a graph has a meaning") {
  CHECK(without_meaning<erp::Graph>() == std::vector<std::string>{});
}

TEST_CASE("erp help robot prints type, range, default and meaning") {
  std::ostringstream out;
  launch::print_reference("robot", out);
  CHECK_THAT(out.str(), Catch::Contains("resistance_ohm") && Catch::Contains("number > 0") &&
                            Catch::Contains("required") && Catch::Contains("default"));
}

TEST_CASE("erp help of an unknown format names the known ones") {
  std::ostringstream out;
  CHECK_THROWS_WITH(launch::print_reference("robt", out), Catch::Contains("robot"));
}

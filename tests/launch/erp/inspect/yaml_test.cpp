#include "launch/erp/inspect/yaml.hpp"

#include <catch2/catch.hpp>

using recording::Members;
using recording::Structure;
using recording::Value;
using recording::Values;

namespace {

Structure structure(std::vector<std::string> names) {
  Structure type;
  for (auto& name : names) type.fields.push_back({std::move(name)});
  return type;
}

}  // namespace

TEST_CASE("a message has one line per field, and its samples are a list") {
  const auto sample = structure({"name", "tension_N"});
  const auto frame = structure({"robot", "sequence", "gains", "actuators"});
  const Members flexor{&sample, {Value{std::string("flexor")}, Value{2.5}}};
  const Members extensor{&sample, {Value{std::string("extensor")}, Value{-1.0}}};
  const Members message{
      &frame,
      {Value{std::string("rig")}, Value{std::uint64_t{7}}, Value{Values{Value{1.0}, Value{2.0}}},
       Value{Values{Value{flexor}, Value{extensor}}}}};
  CHECK(launch::to_yaml(message) ==
        "robot: rig\n"
        "sequence: 7\n"
        "gains: [1,2]\n"
        "actuators:\n"
        "  - name: flexor\n"
        "    tension_N: 2.5\n"
        "  - name: extensor\n"
        "    tension_N: -1\n");
}

TEST_CASE(
    "an enumeration value of an erp message has its name as comment; that of another package has "
    "none") {
  auto erp_type = structure({"mode", "valid", "unknown_field"});
  auto other_type = erp_type;
  erp_type.name = "erp/msg/ActuatorSample", other_type.name = "other/msg/ActuatorSample";
  const Values numbers{Value{std::uint64_t{4}}, Value{std::uint64_t{6}}, Value{std::uint64_t{4}}};
  CHECK(launch::to_yaml({&erp_type, numbers}) ==
        "mode: 4  # force\nvalid: 6  # current shaft\nunknown_field: 4\n");
  CHECK(launch::to_yaml({&other_type, numbers}) == "mode: 4\nvalid: 6\nunknown_field: 4\n");
  erp_type.name = "erp/msg/JointSample";
  CHECK(launch::to_yaml(
            {&erp_type, {Value{std::uint64_t{9}}, Value{std::uint64_t{1}}, numbers[2]}}) ==
        "mode: 9\nvalid: 1  # angle\nunknown_field: 4\n");
}

TEST_CASE("an empty sequence is [], and a nested structure is indented") {
  const auto inner = structure({"x"});
  const auto outer = structure({"list", "inner"});
  const Members message{&outer, {Value{Values{}}, Value{Members{&inner, {Value{true}}}}}};
  CHECK(launch::to_yaml(message) == "list: []\ninner:\n  x: true\n");
}

TEST_CASE("text that YAML would read as another type is quoted") {
  const auto type = structure({"text"});
  const auto yaml = [&](const char* text) {
    return launch::to_yaml({&type, {Value{std::string(text)}}});
  };
  CHECK(yaml("plain words") == "text: plain words\n");
  CHECK(yaml("") == "text: \"\"\n");
  CHECK(yaml("12") == "text: \"12\"\n");
  CHECK(yaml("a: b") == "text: \"a: b\"\n");
  CHECK(yaml("true") == "text: \"true\"\n");
}

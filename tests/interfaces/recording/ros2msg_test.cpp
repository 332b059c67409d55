#include "interfaces/recording/ros2msg.hpp"

#include <catch2/catch.hpp>

using namespace recording;

TEST_CASE("a type written as ros2msg text is parsed to the same type") {
  TypeDescription type;
  type.structures.push_back(
      {"erp/msg/Frame",
       {{.name = "robot", .kind = Kind::string, .string_bound = 32},
        {.name = "stamp_ns", .kind = Kind::int64, .unit = "ns"},
        {.name = "samples",
         .kind = Kind::structure,
         .structure = 1,
         .count = Count::sequence,
         .size = 64},
        {.name = "q", .kind = Kind::float64, .count = Count::array, .size = 4},
        {.name = "names", .kind = Kind::string, .count = Count::sequence, .string_bound = 8},
        {.name = "ok", .kind = Kind::boolean},
        {.name = "v", .kind = Kind::int8},
        {.name = "V", .kind = Kind::int8},
        {.name = "_Odd__Name_", .kind = Kind::int8}}});
  type.structures.push_back(
      {"erp/msg/Sample", {{.name = "tension_N", .kind = Kind::float32, .unit = "N"}}});
  const std::string text = ros2msg_text(type);
  CHECK(text ==
        "string<=32 robot\nint64 stamp_ns  # [ns]\nerp/Sample[<=64] samples\nfloat64[4] q\n"
        "string<=8[] names\nbool ok\nint8 v\nint8 v2  # V\nint8 odd_name  # _Odd__Name_\n" +
            std::string(80, '=') + "\nMSG: erp/Sample\nfloat32 tension_n  # tension_N [N]\n");
  const TypeDescription parsed = parse_ros2msg("erp/msg/Frame", text);
  CHECK(ros2msg_text(parsed) == text);
  for (std::size_t s = 0; s < 2; ++s)
    for (std::size_t i = 0; i < type.structures[s].fields.size(); ++i) {
      CHECK(parsed.structures[s].fields[i].name == type.structures[s].fields[i].name);
      CHECK(parsed.structures[s].fields[i].unit == type.structures[s].fields[i].unit);
    }
  CHECK(parse_ros2msg("erp/msg/Frame", text).name() == "erp/msg/Frame");
}

TEST_CASE("constants, defaults, comments and short names in a user's message are parsed") {
  const TypeDescription type = parse_ros2msg(
      "a/B",
      "# a message\nint32 LIMIT=5\nstring NAME = \"x\"\n  int32 n 7 # with a default\r\nbyte raw\n"
      "Inner one\nb/msg/Other two\n\n====\nMSG: a/Inner\nchar c\n====\nMSG: b/Other\nbool x\n");
  REQUIRE(type.root().fields.size() == 4);
  CHECK(type.name() == "a/msg/B");
  CHECK(type.root().fields[0].name == "n");
  CHECK(type.root().fields[1].kind == Kind::uint8);
  CHECK(type.structures[type.root().fields[2].structure].name == "a/msg/Inner");
  CHECK(type.structures[type.root().fields[3].structure].name == "b/msg/Other");
}

TEST_CASE("an ordinary comment does not rename a field") {
  const auto field = [](const std::string& line) {
    return parse_ros2msg("a/msg/B", line).root().fields[0];
  };
  CHECK(field("float64 x # height\n").name == "x");
  CHECK(field("float64 x # X is the height\n").name == "x");
  CHECK(field("float64 x # in [m] or so\n").unit.empty());
  CHECK(field("float64 x # [m]\n").unit == "m");
}

TEST_CASE("an invalid schema is rejected with its name, line and value") {
  const auto check_rejected = [](const std::string& text, const std::string& message) {
    CHECK_THROWS_WITH(parse_ros2msg("a/msg/B", text),
                      Catch::Contains("a/msg/B") && Catch::Contains(message));
  };
  check_rejected("bool ok\nMissing x\n", ":2: unknown type \"Missing\"");
  check_rejected("float64\n", ":1: \"float64\" is not");
  check_rejected("float64 3d\n", ":1:");
  check_rejected("float64[x] a\n", ":1: \"x\" is not a count");
  check_rejected("float64[0] a\n", "\"0\" is not a count");
  check_rejected("float64[99999999999] a\n", "is not a count");
  check_rejected("float64[2 a\n", "lacks a ]");
  check_rejected("int8<=3 a\n", "only a string has a bound");
  check_rejected("", "has no fields");
  check_rejected("B again\n", "contains itself");
  check_rejected("In x\n===\nMSG: a/In\nB[] back\n", "contains itself");
  check_rejected("bool x\nbool x\n", "is defined twice");
  check_rejected("bool x\n===\nbool y\n", ":3: expected \"MSG:");
}

TEST_CASE("a schema whose size doubles at each of 30 levels is parsed without expansion") {
  std::string text = "L0 a\nL0 b\n";
  for (int i = 0; i < 30; ++i) {
    const std::string next = i < 29 ? "L" + std::to_string(i + 1) : "uint8";
    text += "===\nMSG: a/L" + std::to_string(i) + "\n" + next + "[1000] a\n" + next + "[1000] b\n";
  }
  CHECK(parse_ros2msg("a/msg/B", text).root().least_bytes == std::size_t{1} << 31);
}

TEST_CASE("IDL names are converted to package and type") {
  CHECK(ros_name("erp::SensorFrame") == "erp/msg/SensorFrame");
  CHECK(ros_name("sensor_msgs::msg::dds_::JointState_") == "sensor_msgs/msg/JointState");
  CHECK(ros_name("a::b::C") == "a_b/msg/C");
  CHECK(ros_name("Alone") == "idl/msg/Alone");
}

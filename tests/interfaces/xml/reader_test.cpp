#include "interfaces/xml/reader.hpp"

#include <catch2/catch.hpp>

#include "tests/interfaces/xml/example.hpp"

using Catch::Contains;
using example::Cart;
using example::params_of;
using example::refusal_of;
using example::refusal_of_params;
using example::Row;

TEST_CASE("a component's parameters of every type are read") {
  const auto p = params_of(
      "<tracker gain_per_s='2.5' mode='slow' enabled='true' offset_m='0 -1 1e-3' limit_N='7' "
      "names=' a  b ' factor='0.25'><track name='x' step='3'/><track name='y'/></tracker>");
  CHECK(p.gain_per_s == 2.5);
  CHECK(p.mode == example::Mode::slow);
  CHECK(p.enabled);
  CHECK(p.offset_m == xml::Vec3{0, -1, 1e-3});
  CHECK(p.limit_N == 7.0);
  CHECK(p.names == std::vector<std::string>{"a", "b"});
  CHECK(p.factor == 0.25f);
  REQUIRE(p.tracks.size() == 2);
  CHECK(p.tracks[0].step == 3);
  CHECK(p.tracks[1].place.column == 142);
}

TEST_CASE("parameters absent from a file keep their defaults") {
  const auto p = params_of("<tracker gain_per_s='2'/>");
  CHECK(p.mode == example::Mode::fast);
  CHECK_FALSE(p.limit_N.has_value());
  CHECK(p.tracks.empty());
}

TEST_CASE("numbers are decimal and finite, with white space and a sign allowed") {
  CHECK(params_of("<tracker gain_per_s=' +1.5E0 '/>").gain_per_s == 1.5);
  for (const char* text : {"", " ", "one", "1,5", "1.5 m", "0x10", "1e", "+-1", "--1"})
    CHECK_THAT(refusal_of_params("<tracker gain_per_s='" + std::string(text) + "'/>"),
               Contains("is not a number"));
  for (const char* text : {"nan", "inf", "-INF", "infinity"})
    CHECK_THAT(refusal_of_params("<tracker gain_per_s='" + std::string(text) + "'/>"),
               Contains("is not a finite number"));
}

TEST_CASE("integers with a fraction or out of range are rejected") {
  const auto step = [](const std::string& text) {
    return refusal_of_params("<tracker gain_per_s='1'><track name='a' step='" + text +
                             "'/></tracker>");
  };
  CHECK(step("10").empty());
  CHECK_THAT(step("2.0"), Contains("is not an integer; give an integer from 1 to 10"));
  CHECK_THAT(step("11"), Contains("step=\"11\" is out of range"));
  CHECK_THAT(step("4294967298"), Contains("is out of range"));
  CHECK_THAT(step("99999999999999999999"), Contains("is out of range"));
}

TEST_CASE(
    "an unknown name is rejected with the nearest known name, which is not reported missing") {
  CHECK(refusal_of_params("<tracker gain='1'/>") ==
        "f.xml:1:10: <tracker>: unknown attribute \"gain\"; did you mean \"gain_per_s\"?");
  CHECK(refusal_of<Cart>("<cart><wheal/></cart>") ==
        "f.xml:1:7: <cart>: unknown element \"wheal\"; did you mean \"wheel\"?");
}

TEST_CASE("all errors of a file are reported at once, in the order of their places") {
  CHECK(refusal_of_params("<tracker mode='medium' colour='red'>\n<track step='0'/>x</tracker>") ==
        "f.xml:1:1: <tracker>: attribute \"gain_per_s\" is missing; add gain_per_s=\"…\"\n"
        "f.xml:1:10: <tracker>: mode=\"medium\" is not one of slow, fast; choose one of them\n"
        "f.xml:1:24: <tracker>: unknown attribute \"colour\"; valid names: gain_per_s, mode, "
        "enabled, offset_m, limit_N, names, factor\n"
        "f.xml:2:1: <track>: attribute \"name\" is missing; add name=\"…\"\n"
        "f.xml:2:8: <track>: step=\"0\" is out of range; give an integer from 1 to 10\n"
        "f.xml:2:18: <tracker>: stray text \"x\"; remove it, or put it into a comment");
}

TEST_CASE("a single child is required exactly once, an optional child at most once") {
  CHECK(xml::parse<Cart>("<cart><wheel radius_m='2'/></cart>", "f.xml").wheel.radius_m == 2);
  CHECK(xml::parse<Cart>("<cart><bell tone='c'/><wheel/></cart>", "f.xml").bell->tone == "c");
  CHECK(refusal_of<Cart>("<cart/>") == "f.xml:1:1: <cart>: element <wheel> is missing; add one");
  CHECK(refusal_of<Cart>("<cart><wheel/><wheel/></cart>") ==
        "f.xml:1:15: <cart>: a second <wheel>; keep one; the first is in line 1");
  CHECK_THAT(refusal_of<Cart>("<cart><wheel/><bell/><bell/></cart>"), Contains("a second <bell>"));
}

TEST_CASE("a list of several kinds keeps its order") {
  const auto row = xml::parse<Row>("<row><bell/><wheel/><bell tone='d'/></row>", "f.xml");
  REQUIRE(row.things.size() == 3);
  CHECK(row.things[0].index() == 1);
  CHECK(row.things[1].index() == 0);
  CHECK(std::get<example::Bell>(row.things[2]).tone == "d");
}

TEST_CASE("attributes with which an editor finds the XSD are allowed") {
  CHECK(refusal_of<Row>("<row xmlns:xsi='http://www.w3.org/2001/XMLSchema-instance' "
                        "xsi:noNamespaceSchemaLocation='row.xsd'/>")
            .empty());
}

TEST_CASE("a file with another root element is rejected") {
  CHECK(refusal_of<Row>("<raw/>") ==
        "f.xml:1:1: <raw>: the root element must be <row>; did you mean \"row\"?");
}

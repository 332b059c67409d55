#include "interfaces/xml/set.hpp"

#include <catch2/catch.hpp>

#include "tests/interfaces/xml/example.hpp"

using example::refusal;

TEST_CASE("a path selects an attribute of the struct, of a single child or of a named list item") {
  example::Params p;
  p.tracks = {{{}, "flexor", 1}, {{}, "extensor", 1}};
  xml::set(p, "gain_per_s", "4");
  xml::set(p, "extensor.step", "7");
  CHECK(p.gain_per_s == 4);
  CHECK(p.tracks[0].step == 1);
  CHECK(p.tracks[1].step == 7);
  example::Cart cart;
  xml::set(cart, "wheel.radius_m", "3");
  xml::set(cart, "bell.tone", "d");
  CHECK(cart.wheel.radius_m == 3);
  CHECK(cart.bell->tone == "d");
}

TEST_CASE("an invalid value changes nothing and is rejected with the valid range") {
  example::Params p;
  CHECK(refusal([&] { xml::set(p, "gain_per_s", "-1"); }) ==
        "--set gain_per_s=-1: is out of range; give a number > 0");
  CHECK(p.gain_per_s == 1);
  CHECK_THAT(refusal([&] { xml::set(p, "mode", "slo"); }),
             Catch::Contains("did you mean \"slow\"?"));
  CHECK_THAT(refusal([&] { xml::set(p, "limit_N", "x"); }), Catch::Contains("is not a number"));
  CHECK_FALSE(p.limit_N.has_value());
}

TEST_CASE("an unknown path is rejected with the nearest name, at every level") {
  example::Params p;
  p.tracks = {{{}, "flexor", 1}};
  CHECK_THAT(refusal([&] { xml::set(p, "gian_per_s", "1"); }),
             Catch::Contains("did you mean \"gain_per_s\"?"));
  CHECK_THAT(refusal([&] { xml::set(p, "flexer.step", "1"); }),
             Catch::Contains("did you mean \"flexor\"?"));
  CHECK_THAT(refusal([&] { xml::set(p, "flexor.stop", "1"); }),
             Catch::Contains("did you mean \"step\"?"));
  CHECK_FALSE(refusal([&] { xml::set(p, "flexor", "1"); }).empty());
  CHECK_FALSE(refusal([&] { xml::set(p, "gain_per_s.x", "1"); }).empty());
  CHECK_FALSE(refusal([&] { xml::set(p, "", "1"); }).empty());
}

TEST_CASE("the help lists names, types, ranges, units and defaults") {
  CHECK(xml::describe<example::Params>() ==
        "gain_per_s  number > 0            1/s  required\n"
        "mode        slow | fast                default fast\n"
        "enabled     true or false              default false\n"
        "offset_m    3 × number            m    default 0 0 0\n"
        "limit_N     number >= 0           N\n"
        "names       list of text\n"
        "factor      number                     default 0.5\n"
        "<track>     any number\n"
        "  name      text                       required\n"
        "  step      integer from 1 to 10       default 1\n");
}

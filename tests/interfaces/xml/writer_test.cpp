#include "interfaces/xml/writer.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <random>

#include "tests/interfaces/xml/example.hpp"

namespace {

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

}  // namespace

TEST_CASE("optional attributes equal to their default are omitted, required ones are written") {
  example::Params p;
  CHECK(xml::write(p, "tracker") ==
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<tracker gain_per_s=\"1\"/>\n");
  p.mode = example::Mode::slow;
  p.limit_N = 0;
  p.tracks.push_back({{}, "a", 2});
  CHECK(xml::write(p, "tracker") ==
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<tracker gain_per_s=\"1\" mode=\"slow\" limit_N=\"0\">\n"
        "  <track name=\"a\" step=\"2\"/>\n"
        "</tracker>\n");
}

TEST_CASE("any finite number is read back bit-equal") {
  std::mt19937_64 random(1);
  for (int i = 0; i < 20000; ++i) {
    const std::uint64_t bits = random();
    double value = 0;
    std::memcpy(&value, &bits, sizeof value);
    if (!std::isfinite(value)) continue;
    double read_back = 0;
    REQUIRE_FALSE(xml::read_number(xml::write_number(value), read_back, xml::any));
    REQUIRE(same_bits(read_back, value));
  }
  double read_back = 1;
  REQUIRE_FALSE(xml::read_number(xml::write_number(-0.0), read_back, xml::any));
  CHECK(same_bits(read_back, -0.0));
}

TEST_CASE("numbers of at least 1e-4 and below 1e20 are written without an exponent") {
  CHECK(xml::write_number(1e9) == "1000000000");
  CHECK(xml::write_number(-0.0004) == "-0.0004");
  CHECK(xml::write_number(57.3e-6) == "5.73e-05");
  CHECK(xml::write_number(0.1f) == "0.1");
}

TEST_CASE("any text is read back equal, including markup and line breaks") {
  const example::Row row{{example::Bell{"<&>\"'\r\n\t größe  "}}};
  const auto read_back = xml::parse<example::Row>(xml::write(row), "f.xml");
  CHECK(std::get<example::Bell>(read_back.things.at(0)).tone == "<&>\"'\r\n\t größe  ");
}

TEST_CASE("single and optional children are written and read back") {
  example::Cart cart;
  cart.wheel.radius_m = 0.25;
  cart.bell = example::Bell{"c"};
  const std::string text = xml::write(cart);
  CHECK(xml::write(xml::parse<example::Cart>(text, "f.xml")) == text);
}

TEST_CASE("elements longer than 100 columns are wrapped") {
  example::Params p;
  p.names.assign(8, "a_rather_long_name");
  p.offset_m = {0.1, 0.2, 0.3};
  p.mode = example::Mode::slow;
  p.enabled = true;
  const std::string text = xml::write(p, "tracker");
  CHECK_THAT(text, Catch::Contains("\n         names="));
  CHECK(example::params_of(text).names == p.names);
}

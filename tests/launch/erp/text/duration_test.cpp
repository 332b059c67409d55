#include "launch/erp/text/duration.hpp"

#include <catch2/catch.hpp>
#include <stdexcept>

using Catch::Matchers::Contains;

TEST_CASE("a duration is parsed with its unit, or in seconds without a unit") {
  CHECK(launch::parse_duration_s("20s") == Approx(20));
  CHECK(launch::parse_duration_s("500ms") == Approx(0.5));
  CHECK(launch::parse_duration_s("2min") == Approx(120));
  CHECK(launch::parse_duration_s("1.5h") == Approx(5400));
  CHECK(launch::parse_duration_s("3") == Approx(3));
}

TEST_CASE("a text that is not a duration is rejected with examples") {
  for (const char* text : {"", "s", "20 s", "-3s", "0s", "5kg", "inf", "nan", "1e400s"}) {
    INFO(text);
    CHECK_THROWS_WITH(launch::parse_duration_s(text), Contains("20s, 500ms, 2min"));
  }
}

TEST_CASE("a duration is printed with at most three digits, or in minutes and seconds") {
  CHECK(launch::to_text_s(0.854) == "0.85 s");
  CHECK(launch::to_text_s(20) == "20.0 s");
  CHECK(launch::to_text_s(59.96) == "60 s");
  CHECK(launch::to_text_s(125.2) == "2 min 05 s");
}

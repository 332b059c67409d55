#include "launch/erp/text/columns.hpp"

#include <catch2/catch.hpp>

using Strings = std::vector<std::string>;

TEST_CASE("columns are aligned by characters, not by bytes") {
  CHECK(launch::align({{"a", "µs"}, {"long", "1 m"}}, {false, true}) ==
        Strings{"a      µs", "long  1 m"});
}

TEST_CASE("clipped cuts a line between characters") {
  CHECK(launch::clipped("µµµ", 2) == "µµ");
  CHECK(launch::clipped("abc", 5) == "abc");
}

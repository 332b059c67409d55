#include "interfaces/xml/words.hpp"

#include <catch2/catch.hpp>

TEST_CASE("the edit distance counts letters to insert, delete or replace, ignoring case") {
  CHECK(xml::edit_distance("kitten", "sitting") == 3);
  CHECK(xml::edit_distance("", "abc") == 3);
  CHECK(xml::edit_distance("Mass_KG", "mass_kg") == 0);
}

TEST_CASE("names with typing errors or another unit have a nearest name; other words have none") {
  const std::vector<std::string> known{"length_m", "mass_kg", "name"};
  CHECK(xml::nearest("legnth_m", known) == "length_m");
  CHECK(xml::nearest("mass", known) == "mass_kg");
  CHECK(xml::nearest("length_mm", known) == "length_m");
  CHECK(xml::nearest("length_inch", known) == "length_m");
  CHECK(xml::nearest("colour", known).empty());
  CHECK(xml::nearest("x", known).empty());
}

TEST_CASE("all known names are listed if no name is near") {
  CHECK(xml::did_you_mean("colour", {"name", "mass_kg"}) == "valid names: name, mass_kg");
  CHECK(xml::did_you_mean("colour", {}) == "remove it");
}

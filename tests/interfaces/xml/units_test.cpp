#include "interfaces/xml/units.hpp"

#include <catch2/catch.hpp>

TEST_CASE("the unit is the end of a name; per becomes a quotient and digits become powers") {
  CHECK(xml::unit_of("mass_kg") == "kg");
  CHECK(xml::unit_of("raise_N_per_s") == "N/s");
  CHECK(xml::unit_of("back_emf_V_s_per_rad") == "V s/rad");
  CHECK(xml::unit_of("inertia_kg_m2") == "kg m²");
  CHECK(xml::unit_of("kp_per_s2") == "1/s²");
  CHECK(xml::unit_of("per_N") == "1/N");
  CHECK(xml::unit_of("  brake_s") == "s");
}

TEST_CASE("a name without a unit gives an empty text") {
  CHECK(xml::unit_of("name") == "");
  CHECK(xml::unit_of("counts") == "");
  CHECK(xml::unit_of("half_width") == "");
}

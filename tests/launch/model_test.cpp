#include "launch/erp/model.hpp"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <sstream>

namespace fs = std::filesystem;

namespace {
const std::string arm = ERP_SOURCE_DIR "/configs/arm/robot.xml";
}

TEST_CASE("a robot in figures") {
  std::ostringstream words, json;
  CHECK(launch::model_info(arm, false, words) == 0);
  CHECK(launch::model_info(arm, true, json) == 0);
  CHECK_THAT(words.str(), Catch::Contains("degrees of freedom  4\n") &&
                              Catch::Contains("mass                2.95 kg\n"));
  CHECK_THAT(json.str(), Catch::Contains("\"muscles\": 11") && Catch::EndsWith("}\n"));
}

TEST_CASE("an ending that names no format is refused with those that do") {
  CHECK_THROWS_WITH(launch::model_export(arm, "arm.obj"), Catch::Contains(".mjcf.xml"));
  CHECK_THROWS_AS(launch::model_export(arm, "/no/such/folder/arm.mjcf.xml"), std::invalid_argument);
}

#include "launch/erp/model/model.hpp"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace fs = std::filesystem;

namespace {
const std::string arm = ERP_SOURCE_DIR "/configs/arm/robot.xml";
}

TEST_CASE("info prints the properties of the arm as text and as JSON") {
  std::ostringstream text, json;
  CHECK(launch::model_info(arm, false, text) == 0);
  CHECK(launch::model_info(arm, true, json) == 0);
  CHECK_THAT(text.str(), Catch::Contains("degrees of freedom  4\n") &&
                             Catch::Contains("mass                2.95 kg\n"));
  CHECK_THAT(json.str(), Catch::Contains("\"muscles\": 11") && Catch::EndsWith("}\n"));
}

TEST_CASE("info lists the effects of robot.xml") {
  const auto file = (fs::temp_directory_path() / ("erp_info_" + std::to_string(getpid()))).string();
  std::ofstream(file)
      << "<robot name=\"arm\"><include file=\"" << arm
      << "\"/><effect type=\"joint_coulomb\" on=\"elbow\" extra_Nm=\"0.1\"/></robot>";
  std::ostringstream text;
  CHECK(launch::model_info(file, false, text) == 0);
  fs::remove(file);
  CHECK_THAT(text.str(), Catch::EndsWith("effect              joint_coulomb on elbow\n"));
}

TEST_CASE("an unknown file name extension is rejected with the known ones") {
  CHECK_THROWS_WITH(launch::model_export(arm, "arm.obj"), Catch::Contains(".mjcf.xml"));
  CHECK_THROWS_AS(launch::model_export(arm, "/no/such/folder/arm.mjcf.xml"), std::invalid_argument);
}

TEST_CASE("balance prints pretensions that robot.xml can include") {
  std::ostringstream pretensions;
  CHECK(launch::model_balance(arm, 5, 10, pretensions) == 0);
  const fs::path folder = fs::temp_directory_path() / ("erp_model_" + std::to_string(getpid()));
  fs::create_directories(folder);
  std::ofstream(folder / "pretension.xml") << pretensions.str();
  std::ofstream(folder / "robot.xml") << "<robot name=\"arm\"><include file=\"" << arm
                                      << "\"/><include file=\"pretension.xml\"/></robot>";
  const erp::Robot before = erp::read_robot(arm), balanced = erp::read_robot(folder / "robot.xml");
  for (std::size_t k = 0; k < before.actuators.size(); ++k) {
    CAPTURE(before.actuators[k].name);
    // the arm's pretensions are rounded results of the same computation
    CHECK(balanced.actuators[k].tendon.pretension_N ==
          Approx(before.actuators[k].tendon.pretension_N).margin(0.06));
  }
  CHECK(balanced.pretensions.empty());
  fs::remove_all(folder);
}

TEST_CASE("the picture of a robot has the name of every muscle") {
  const fs::path file = fs::temp_directory_path() / ("erp_" + std::to_string(getpid()) + ".svg");
  CHECK(launch::model_export(arm, file) == 0);
  std::stringstream picture;
  picture << std::ifstream(file).rdbuf();
  for (const erp::Actuator& actuator : erp::read_robot(arm).actuators)
    CHECK_THAT(picture.str(), Catch::Contains("<title>" + actuator.name + "</title>"));
  fs::remove(file);
}

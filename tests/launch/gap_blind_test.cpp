#include "launch/erp/gap_blind.hpp"

#include <unistd.h>
#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "launch/erp/gap.hpp"
#include "tests/sim/rigs.hpp"

namespace fs = std::filesystem;

namespace {

struct Folder {
  fs::path path = fs::temp_directory_path() / ("erp_blind_" + std::to_string(::getpid()));
  Folder() { fs::create_directories(path); }
  ~Folder() { fs::remove_all(path); }
};

const std::string robot_file = rigs::config("hinge_rig/robot.xml");

}  // namespace

TEST_CASE("cases are made, diagnosed without their truth, scored; the seal holds") {
  const Folder folder;
  const std::string cases = folder.path / "cases", truth = folder.path / "truth.json";
  std::ostringstream out, remarks;
  launch::BlindMakeOptions make{.robot = robot_file, .out = cases, .truth = truth};
  make.cases = 2, make.recordings = 3, make.seconds = 5, make.seed = 14;
  REQUIRE(launch::blind_make(make, out, remarks) == 0);
  const std::string before = out.str();
  REQUIRE(launch::blind_run(cases, 2, out, remarks) == 0);
  out.str("");
  REQUIRE(launch::blind_score(cases, truth, out) == 0);
  CHECK_THAT(out.str(), Catch::Contains("stage and place") && Catch::Contains("(2 of 2)"));

  const auto d = nlohmann::json::parse(std::ifstream(cases + "/case_0001/diagnosis.json"));
  for (const char* name :
       {"verdict", "where", "effects", "confusable", "gap", "recordings", "warnings"})
    CHECK(d.contains(name));
  for (const char* name :
       {"type", "on", "parameters", "intervals", "gain", "gain_interval", "supported"})
    CHECK(d["effects"][0].contains(name));
  for (const char* name : {"before", "floor", "after", "closed", "closed_interval"})
    CHECK(d["gap"].contains(name));

  std::ofstream(truth, std::ios::app) << " ";
  out.str("");
  CHECK(launch::blind_score(cases, truth, out) == 1);
  CHECK_THAT(out.str(), Catch::Contains("hash"));
}

TEST_CASE("a diagnosis leaves a report, figures and a robot that the library reads again") {
  const Folder folder;
  const std::string cases = folder.path / "cases", truth = folder.path / "truth.json";
  std::ostringstream out, remarks;
  launch::BlindMakeOptions make{.robot = robot_file, .out = cases, .truth = truth};
  make.cases = 1, make.recordings = 3, make.seconds = 5, make.seed = 14;
  REQUIRE(launch::blind_make(make, out, remarks) == 0);
  launch::GapDiagnoseOptions how{.robot = robot_file, .out = folder.path / "found"};
  for (int k = 1; k <= 3; ++k)
    how.recordings.push_back(cases + "/case_0001/" + std::to_string(k) + ".csv");
  CHECK(launch::gap_diagnose(how, out, remarks) == 0);
  CHECK(fs::file_size(folder.path / "found/report.html") > 5000);
  const erp::Robot with = erp::read_robot(folder.path / "found/robot.xml");
  CHECK(with.effects.size() == 1);
  how.withhold = {"no_such_effect"};
  CHECK_THROWS_WITH(launch::gap_diagnose(how, out, remarks), Catch::Contains("erp model effects"));
}

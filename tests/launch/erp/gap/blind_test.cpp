#include "launch/erp/gap/blind.hpp"

#include <unistd.h>
#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "launch/erp/gap/truth.hpp"
#include "tests/sim/rigs.hpp"

namespace fs = std::filesystem;

namespace {

struct BlindFolder {
  fs::path path = fs::temp_directory_path() / ("erp_blind_" + std::to_string(::getpid()));
  BlindFolder() { fs::create_directories(path); }
  ~BlindFolder() { fs::remove_all(path); }
};

const std::string blind_robot_file = rigs::config("hinge_rig/robot.xml");

}  // namespace

TEST_CASE("blind cases are made, diagnosed and scored; a changed truth file is rejected") {
  const BlindFolder folder;
  const std::string cases = folder.path / "cases", truth = folder.path / "sealed/truth.json";
  std::ostringstream out, remarks;
  launch::gap::BlindMakeOptions make{.robot = blind_robot_file, .out = cases, .truth = truth};
  make.cases = 2, make.recordings = 3, make.seconds = 5, make.seed = 14;
  REQUIRE(launch::gap::blind_make(make, out, remarks) == 0);
  REQUIRE(launch::gap::blind_run({cases, 2}, out, remarks) == 0);
  out.str("");
  REQUIRE(launch::gap::blind_score(cases, truth, out) == 0);
  CHECK_THAT(out.str(), Catch::Contains("stage and place") && Catch::Contains("(2 of 2)"));

  const auto diagnosis = nlohmann::json::parse(std::ifstream(cases + "/case_0001/diagnosis.json"));
  for (const char* name :
       {"verdict", "where", "effects", "confounders", "gap", "recordings", "warnings"})
    CHECK(diagnosis.contains(name));
  for (const char* name :
       {"type", "on", "parameters", "intervals", "gain", "gain_interval", "supported"})
    CHECK(diagnosis["effects"][0].contains(name));
  for (const char* name : {"before", "floor", "after", "closed", "closed_interval"})
    CHECK(diagnosis["gap"].contains(name));

  fs::remove(cases + "/case_0002/diagnosis.json");
  out.str("");
  CHECK(launch::gap::blind_score(cases, truth, out) == 5);
  CHECK_THAT(out.str(), Catch::Contains("1 of 2 cases not diagnosed; run erp gap blind run "));

  CHECK_THROWS_WITH(launch::gap::blind_make(make, out, remarks),
                    Catch::Contains("already contains cases"));
  std::ofstream(truth, std::ios::app) << " ";
  CHECK_THROWS_WITH(launch::gap::blind_score(cases, truth, out), Catch::Contains("hash"));
}

TEST_CASE(
    "blind make rejects a robot without actuators or with effects, an existing truth file, and a "
    "truth file inside the folder of the cases") {
  const BlindFolder folder;
  std::ostringstream out, remarks;
  launch::gap::BlindMakeOptions make{.robot = blind_robot_file,
                                     .out = folder.path / "cases",
                                     .truth = folder.path / "cases/truth.json"};
  const auto check_rejected = [&](const char* reason) {
    CHECK_THROWS_WITH(launch::gap::blind_make(make, out, remarks), Catch::Contains(reason));
    CHECK_FALSE(fs::exists(folder.path / "cases"));
  };
  check_rejected("is in the folder of the cases");
  make.truth = folder.path / "truth.json";
  std::ofstream(make.truth) << "[]";
  check_rejected("belongs to other cases");
  make.truth = folder.path / "another.json";
  make.robot = rigs::config("drive/robot.xml");
  check_rejected("has no actuator");
  erp::Robot with_effect = erp::read_robot(blind_robot_file);
  with_effect.effects = {{{}, "gearbox_coulomb", "extensor", {{{}, "extra_Nm", "0.03"}}}};
  make.robot = folder.path / "with_effect.xml";
  std::ofstream(make.robot) << erp::write_robot(with_effect);
  check_rejected("has effects");
}

TEST_CASE("a robot whose initial pose is beyond its stops is recorded") {
  const BlindFolder folder;
  std::string robot = erp::write_robot(erp::read_robot(blind_robot_file));
  const std::string stops = R"(min_rad="-1.2" max_rad="1.6")";
  REQUIRE(robot.find(stops) != robot.npos);
  robot.replace(robot.find(stops), stops.size(), R"(min_rad="-0.01" max_rad="0.01")");
  std::ofstream(folder.path / "robot.xml") << robot;
  std::ostringstream out, remarks;
  launch::gap::BlindMakeOptions make{.robot = folder.path / "robot.xml",
                                     .out = folder.path / "cases",
                                     .truth = folder.path / "truth.json"};
  make.cases = 1, make.recordings = 1, make.seconds = 2, make.seed = 2;
  make.only = {"joint_early_stop"};
  REQUIRE(launch::gap::blind_make(make, out, remarks) == 0);
  CHECK(fs::exists(folder.path / "cases/case_0001/1.csv"));
}

/// Writes the truth file of a folder of diagnoses, and returns the printed score.
std::string score_of(const BlindFolder& folder, const nlohmann::json& truths) {
  const std::string truth = folder.path / "truth.json";
  std::ofstream(truth) << truths.dump();
  std::ofstream(folder.path / "cases.json")
      << nlohmann::json{{"truth_sha256", launch::gap::sha256(truths.dump())}};
  std::ostringstream out;
  REQUIRE(launch::gap::blind_score(folder.path, truth, out) == 0);
  return out.str();
}

TEST_CASE(
    "score of pairs: share of cases with both effects found, and F1 of all reported effects") {
  const BlindFolder folder;
  const auto effect = [](const char* type) {
    return nlohmann::json{{"type", type}, {"on", "flexor"}, {"supported", true}};
  };
  const auto hidden = [](const char* type) {
    return nlohmann::json{{"type", type},
                          {"on", "flexor"},
                          {"stage", "motor"},
                          {"parameters", nlohmann::json::object()}};
  };
  nlohmann::json truths;
  const auto add_case = [&](const char* name, const nlohmann::json& effects,
                            const nlohmann::json& confounders) {
    truths.push_back({{"case", name}, {"kind", "pair"}, {"hidden", {hidden("a"), hidden("b")}}});
    fs::create_directories(folder.path / name);
    std::ofstream(folder.path / name / "diagnosis.json")
        << nlohmann::json{{"verdict", "supported"},
                          {"where", nlohmann::json::array()},
                          {"effects", effects},
                          {"confounders", confounders}};
  };
  const auto no_confounders = nlohmann::json::array();
  add_case("both", {effect("a"), effect("b")}, no_confounders);
  add_case("one_of_three", {effect("a"), effect("c"), effect("d")}, no_confounders);
  auto one = effect("a"), other = effect("equivalent_of_b"), same = effect("b");
  other["set"] = same["set"] = 1;
  add_case("by_equivalent", {one, other}, {other, same});
  const std::string score = score_of(folder, truths);
  INFO(score);
  CHECK_THAT(score, Catch::Contains("(2 of 3)"));
  CHECK_THAT(score, Catch::Contains("0.805"));  // of mean precision 7/9 and mean recall 5/6
  CHECK_THAT(score, Catch::Contains("one_of_three: a on flexor + b on flexor | supported"));
}

TEST_CASE(
    "score of many deviating constants: share of visible errors reported, share of false reports") {
  const BlindFolder folder;
  const auto number = [](const char* name, double value) {
    return nlohmann::json{{"on", "flexor"}, {"name", name}, {"value", value}};
  };
  const auto constant = [](const char* name, double value, double half_width, bool differs) {
    return nlohmann::json{{"on", "flexor"},
                          {"name", name},
                          {"nominal", 1},
                          {"value", value},
                          {"interval", {value - half_width, value + half_width}},
                          {"determined", 0.9},
                          {"differs", differs}};
  };
  const nlohmann::json truths{{{"case", "one"},
                               {"kind", "many"},
                               {"hidden", nlohmann::json::array()},
                               {"numbers",
                                {number("reported", 1.05), number("missed", 1.06),
                                 number("too_small_to_see", 1.02), number("exact", 1)}}}};
  fs::create_directories(folder.path / "one");
  std::ofstream(folder.path / "one/diagnosis.json") << nlohmann::json{
      {"verdict", "supported"},
      {"where", nlohmann::json::array()},
      {"effects", nlohmann::json::array()},
      {"gap", {{"closed", 0.99}, {"free_running", {{"before", 9}, {"floor", 1}, {"closed", 0.8}}}}},
      {"constants",
       {constant("reported", 1.05, 0.01, true), constant("missed", 1.01, 0.01, false),
        constant("too_small_to_see", 1.01, 0.02, false), constant("exact", 1.04, 0.01, true)}}};
  fs::copy(blind_robot_file, folder.path / "robot.xml");
  const std::string score = score_of(folder, truths);
  INFO(score);
  CHECK_THAT(score, Catch::Contains("visible errors reported        50.0 %  (1 of 2)") &&
                        Catch::Contains("false among reported errors    50.0 %  (1 of 2)") &&
                        Catch::Contains("90 % closed in free run         0.0 %  (0 of 1)") &&
                        Catch::Contains("interval contains constant     50.0 %  (2 of 4)"));
}

TEST_CASE("a robot whose constants all deviate by 3 % is drawn, diagnosed and scored") {
  const BlindFolder folder;
  const std::string cases = folder.path / "cases", truth = folder.path / "truth.json";
  std::ostringstream out, remarks;
  launch::gap::BlindMakeOptions make{
      .robot = blind_robot_file, .out = cases, .truth = truth, .kind = "null"};
  make.cases = 1, make.recordings = 3, make.seconds = 8, make.seed = 3, make.tolerance = 0.03;
  make.kind = "many";
  CHECK_THROWS_WITH(launch::gap::blind_make(make, out, remarks),
                    Catch::Contains("--tolerance 0.03"));
  make.kind = "null";
  REQUIRE(launch::gap::blind_make(make, out, remarks) == 0);
  const auto hidden = nlohmann::json::parse(std::ifstream(truth));
  CHECK(hidden[0]["hidden"].empty());
  double largest_deviation = 0;
  int motors = 0;
  for (const auto& number : hidden[0]["numbers"])
    if (number["name"] == "resistance_ohm") {
      const double deviation = number["value"].get<double>() / 0.516 - 1;
      CHECK(deviation != 0);
      ++motors;
      largest_deviation = std::max(largest_deviation, std::abs(deviation));
    }
  CHECK(motors == 2);
  CHECK(largest_deviation < 0.15);
  REQUIRE(launch::gap::blind_run({cases, 2, true}, out, remarks) == 0);
  out.str("");
  REQUIRE(launch::gap::blind_score(cases, truth, out) == 0);
  CHECK_THAT(out.str(), Catch::Contains("null, as built") &&
                            Catch::Contains("explained by constants alone  100.0 %") &&
                            Catch::Contains("90 % closed in free run       100.0 %"));
  const auto diagnosis = nlohmann::json::parse(std::ifstream(cases + "/case_0001/diagnosis.json"));
  CHECK_FALSE(diagnosis["constants"].empty());
  CHECK_FALSE(diagnosis["where"].empty());
}

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <sstream>

#include "launch/erp/gap/files.hpp"
#include "launch/erp/gap/gap.hpp"
#include "tests/launch/erp/gap/recorded.hpp"

namespace fs = std::filesystem;

namespace {

struct Result {
  int code;
  std::string text;
};

Result diagnosed(const RecordedRig& folder, launch::gap::DiagnoseOptions options) {
  if (options.robot.empty()) options.robot = rig_file;
  options.out = folder.path / "found";
  std::ostringstream out, remarks;
  const int code = launch::gap::diagnose(options, out, remarks);
  return {code, out.str()};
}

}  // namespace

TEST_CASE("the corrected model of a robot.xml that includes other files is written as one file") {
  const RecordedRig folder;
  const std::string model = rigs::config("ecce4/robot.xml"), corrected = folder.path / "robot.xml";
  erp::Robot robot = erp::read_robot(model);
  const erp::Effect friction{
      {}, "gearbox_coulomb", robot.actuators[0].name, {{{}, "extra_Nm", "0.03"}}};
  robot.effects.push_back(friction);
  launch::gap::write_corrected(corrected, model, robot, {friction});
  CHECK(erp::write_robot(erp::read_robot(corrected)) == erp::write_robot(robot));
}

TEST_CASE("the exit code reports the verdict; robot.xml is written if the gap is explained") {
  const RecordedRig folder;
  const auto no_gap = folder.recorded("plain.csv", false, 1);
  const auto friction = folder.recorded("friction.csv", true, 1),
             friction_2 = folder.recorded("again.csv", true, 2);

  const Result explained = diagnosed(folder, {.recordings = {friction, friction_2}});
  INFO(explained.text);
  CHECK(explained.code == 0);
  CHECK_THAT(explained.text, Catch::Contains("free run"));
  CHECK_THAT(explained.text, !Catch::Contains("free-run error"));
  const erp::Robot corrected = erp::read_robot(folder.result("robot.xml"));
  REQUIRE(corrected.effects.size() == 1);
  CHECK(corrected.effects[0].type == "gearbox_coulomb");
  CHECK_THAT(folder.read("robot.xml"), Catch::Contains("<!-- One joint, two antagonistic"));

  CHECK(diagnosed(folder, {.recordings = {no_gap}}).code == 3);
  CHECK_FALSE(fs::exists(folder.result("robot.xml")));

  const Result withheld =
      diagnosed(folder, {.recordings = {friction, friction_2},
                         .withhold = {"gearbox_coulomb", "gearbox_asymmetric", "gearbox_stribeck",
                                      "gearbox_ageing_stiction", "gearbox_position_dependent",
                                      "gearbox_load_dependent", "motor_cogging", "motor_dead_band"},
                         .free_run = false});
  INFO(withheld.text);
  CHECK(withheld.code == 4);
  CHECK_THAT(withheld.text, Catch::Contains("unexplained gearbox of extensor") &&
                                Catch::Contains("withheld    gearbox_coulomb, ") &&
                                Catch::Contains("next        erp gap plan --robot "));

  CHECK(diagnosed(folder, {.train = {friction}, .held_out = {no_gap}}).code == 5);

  const Result all_train =
      diagnosed(folder, {.recordings = {friction, friction_2}, .train = {friction, friction_2}});
  CHECK(all_train.code == 5);
  CHECK_THAT(all_train.text, Catch::Contains("no recording is held out") &&
                                 !Catch::Contains("there is only one recording"));
}

TEST_CASE("spindle radii of all actuators wrong by -25 % are identified, not a joint sensor gain") {
  const RecordedRig folder;
  erp::Robot robot = erp::read_robot(rig_file);
  for (erp::Actuator& actuator : robot.actuators) actuator.spindle.radius_m /= 0.75;
  const std::string model = folder.path / "thick.xml";
  std::ofstream(model) << erp::write_robot(robot);
  const Result result = diagnosed(folder, {.robot = model,
                                           .recordings = {folder.recorded("one.csv", false, 1, 12)},
                                           .free_run = false});
  INFO(result.text);
  CHECK(result.code == 0);
  CHECK_THAT(result.text,
             Catch::Contains("cause       spindle_radius on flexor  relative = -0.25") &&
                 Catch::Contains("cause       spindle_radius on extensor  relative = -0.25") &&
                 Catch::Contains("on the rest of the recording"));
}

TEST_CASE("one recording that is too short to be split: not identifiable, candidates are printed") {
  const RecordedRig folder;
  const Result result =
      diagnosed(folder, {.recordings = {folder.recorded("short.csv", true, 1, 1.6)}});
  INFO(result.text);
  CHECK(result.code == 5);
  CHECK_THAT(result.text, Catch::Contains("candidate   gearbox_") &&
                              Catch::Contains("it was not split") &&
                              Catch::Contains("on the training data"));
  CHECK_FALSE(fs::exists(folder.result("robot.xml")));
  CHECK_THAT(folder.read("report.html"), Catch::Contains("no other recording to validate it") &&
                                             Catch::Contains("<p>Candidates:</p>") &&
                                             !Catch::Contains("held-out recordings"));
}

TEST_CASE("a fault of several recordings is printed once, and no experiment is proposed") {
  const RecordedRig folder;
  std::vector<std::string> files;
  for (std::uint64_t seed : {1, 2}) {
    const std::string file = folder.recorded(std::to_string(seed) + ".csv", true, seed);
    scale_column(file, "extensor.voltage_V", -1);
    files.push_back(file);
  }
  const Result result = diagnosed(folder, {.recordings = files, .free_run = false});
  INFO(result.text);
  CHECK_THAT(result.text, Catch::Contains("fix the recording first: " + files[0] + ", " + files[1] +
                                          ": extensor.voltage_V has the opposite sign") &&
                              Catch::Contains("unreliable until the recordings are fixed") &&
                              !Catch::Contains("next        erp gap plan"));
}

TEST_CASE(
    "without a gap but with a suspicious column the verdict is not_identifiable, not no_gap") {
  const RecordedRig folder;
  std::vector<std::string> files;
  for (std::uint64_t seed : {1, 2}) {
    const std::string file = folder.recorded(std::to_string(seed) + ".csv", false, seed);
    scale_column(file, "flexor.current_A", 1000);
    files.push_back(file);
  }
  const Result result = diagnosed(folder, {.recordings = files, .free_run = false});
  INFO(result.text);
  CHECK(result.code == 5);
  CHECK_THAT(result.text, Catch::Contains("verdict     not_identifiable") &&
                              Catch::Contains("fix the recording first: "));
}

TEST_CASE("the report lists the estimated constants, those that deviate from robot.xml first") {
  sim::diagnosis::Diagnosis diagnosis;
  diagnosis.verdict = sim::diagnosis::Verdict::supported;
  const erp::Robot robot = erp::read_robot(rig_file);
  CHECK_THAT(launch::gap::diagnosis_report(diagnosis, {}, robot),
             !Catch::Contains("<h2>Constants</h2>"));
  sim::diagnosis::ConstantEstimate deviating{.name = "resistance_ohm", .on = "flexor"};
  deviating.nominal = 0.5, deviating.tolerance = 0.01, deviating.value = 0.52,
  deviating.interval = {0.515, 0.525};
  deviating.determined = 0.9;
  auto undetermined = deviating;
  undetermined.name = "mass_kg", undetermined.determined = 0.1;
  diagnosis.constants = {undetermined, deviating}, diagnosis.as_built = robot;
  const std::string report = launch::gap::diagnosis_report(diagnosis, {}, robot);
  const auto all = report.find("All 2");
  REQUIRE(all != report.npos);
  CHECK(report.find("resistance_ohm") < all);
  CHECK(report.find("mass_kg") > all);
  CHECK_THAT(report, Catch::Contains("several constants together, each within its tolerance") &&
                         Catch::Contains("0.515 … 0.525") && Catch::Contains("not determined"));
}

TEST_CASE("an output folder that cannot be created is rejected; a failed diagnosis creates none") {
  const RecordedRig folder;
  const auto one = folder.recorded("one.csv", false, 1);
  std::ostringstream out, remarks;
  launch::gap::DiagnoseOptions options{.robot = rig_file, .recordings = {one}};
  options.out = one + "/below_a_file";
  CHECK_THROWS_WITH(launch::gap::diagnose(options, out, remarks),
                    Catch::Contains("cannot be made"));
  options.out = folder.path / "new/er", options.train = {one}, options.held_out = {one};
  CHECK_THROWS(launch::gap::diagnose(options, out, remarks));
  CHECK_FALSE(fs::exists(folder.path / "new"));
}

TEST_CASE("the report shows location, candidate effects and gap closure, and needs no other file") {
  const RecordedRig folder;
  diagnosed(folder,
            {.recordings = {folder.recorded("1.csv", true, 1), folder.recorded("2.csv", true, 2)}});
  const std::string report = folder.read("report.html");
  for (const char* part :
       {"<h2>Location of the gap</h2>", "<h2>Candidate effects</h2>", "% closed (", "Signatures",
        "<h2>Free-run simulation</h2>", "<h2>Largest residuals</h2>", "gearbox_coulomb on extensor",
        "1.csv", "2.csv"})
    CHECK_THAT(report, Catch::Contains(part));
  CHECK_THAT(report, !Catch::Contains("href=") && !Catch::Contains("src=") &&
                         !Catch::Contains("nan") && !Catch::Contains("inf"));

  const auto diagnosis = nlohmann::json::parse(folder.read("diagnosis.json"));
  const auto& first = diagnosis["effects"][0];
  CHECK(first["type"] == "gearbox_coulomb");
  const auto& interval = first["intervals"]["extra_Nm"];
  CHECK(interval[0] < 0.03);
  CHECK(interval[1] > 0.03);
  CHECK(diagnosis["gap"]["closed"] > 0.9);
  CHECK(diagnosis["gap"]["closed_interval"][0] <= diagnosis["gap"]["closed"]);
  for (const auto& [name, channel] : diagnosis["gap"]["channels"].items()) {
    INFO(name);
    CHECK(channel["closed"].is_null() == (name != "gearbox extensor"));
    CHECK(channel["driven_by"] > 0);
  }
}

TEST_CASE("an unknown effect type, a recording given twice or in both lists is rejected by name") {
  const RecordedRig folder;
  const auto one = folder.recorded("one.csv", false, 1), two = folder.recorded("two.csv", false, 2);
  CHECK_THROWS_WITH(diagnosed(folder, {.recordings = {one}, .withhold = {"no_such_effect"}}),
                    Catch::Contains("no_such_effect") && Catch::Contains("erp model effects"));
  CHECK_THROWS_WITH(diagnosed(folder, {.train = {one, two}, .held_out = {two}}),
                    Catch::Contains("two.csv") && Catch::Contains("in both"));
  CHECK_THROWS_WITH(diagnosed(folder, {.recordings = {one}, .held_out = {one}}),
                    Catch::Contains("leave at least one for training"));
  CHECK_THROWS_WITH(diagnosed(folder, {.recordings = {one, two, one}}),
                    Catch::Contains("one.csv") && Catch::Contains("given twice"));
}

TEST_CASE("a robot.xml that erp gap diagnose did not write is neither overwritten nor removed") {
  const RecordedRig folder;
  const auto no_gap = folder.recorded("plain.csv", false, 1);
  fs::create_directories(folder.path / "found");
  const std::string own_model = folder.result("robot.xml");
  fs::copy_file(rig_file, own_model);
  launch::gap::DiagnoseOptions options{.recordings = {no_gap}};
  CHECK_THROWS_WITH(diagnosed(folder, options),
                    Catch::Contains("that erp gap diagnose did not write"));
  std::ostringstream out, remarks;
  options.robot = own_model, options.out = folder.path / "found";
  CHECK_THROWS_WITH(launch::gap::diagnose(options, out, remarks),
                    Catch::Contains("is the model given by --robot"));
  CHECK(folder.read("robot.xml") == [&] {
    std::ifstream in(rig_file);
    return std::string(std::istreambuf_iterator<char>(in), {});
  }());
}

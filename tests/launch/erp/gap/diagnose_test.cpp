#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <sstream>

#include "launch/erp/gap/files.hpp"
#include "launch/erp/gap/gap.hpp"
#include "tests/launch/erp/gap/recorded.hpp"

namespace fs = std::filesystem;

namespace {

struct Told {
  int code;
  std::string text;
};

Told diagnosed(const RecordedRig& folder, launch::gap::DiagnoseOptions how) {
  if (how.robot.empty()) how.robot = rig_file;
  how.out = folder.path / "found";
  std::ostringstream out, remarks;
  const int code = launch::gap::diagnose(how, out, remarks);
  return {code, out.str()};
}

}  // namespace

TEST_CASE("a model that is put together from parts is mended as one file") {
  const RecordedRig folder;
  const std::string model = rigs::config("ecce4/robot.xml"), mended = folder.path / "robot.xml";
  erp::Robot robot = erp::read_robot(model);
  const erp::Effect rubs{
      {}, "gearbox_coulomb", robot.actuators[0].name, {{{}, "extra_Nm", "0.03"}}};
  robot.effects.push_back(rubs);
  launch::gap::write_mended(mended, model, robot, {rubs});
  CHECK(erp::write_robot(erp::read_robot(mended)) == erp::write_robot(robot));
}

TEST_CASE("the exit code says the verdict, and robot.xml is there if the gap is explained") {
  const RecordedRig folder;
  const auto plain = folder.recorded("plain.csv", false, 1);
  const auto rubs = folder.recorded("rubs.csv", true, 1),
             again = folder.recorded("again.csv", true, 2);

  const Told explained = diagnosed(folder, {.recordings = {rubs, again}});
  INFO(explained.text);
  CHECK(explained.code == 0);
  CHECK_THAT(explained.text, Catch::Contains("free run"));
  CHECK_THAT(explained.text, !Catch::Contains("the free run"));
  const erp::Robot with = erp::read_robot(folder.found("robot.xml"));
  REQUIRE(with.effects.size() == 1);
  CHECK(with.effects[0].type == "gearbox_coulomb");
  CHECK_THAT(folder.read("robot.xml"), Catch::Contains("<!-- One joint, two antagonistic"));

  CHECK(diagnosed(folder, {.recordings = {plain}}).code == 3);
  CHECK_FALSE(fs::exists(folder.found("robot.xml")));

  const Told withheld =
      diagnosed(folder, {.recordings = {rubs, again},
                         .withhold = {"gearbox_coulomb", "gearbox_asymmetric", "gearbox_stribeck",
                                      "gearbox_ageing_stiction", "gearbox_position_dependent",
                                      "gearbox_load_dependent", "motor_cogging", "motor_dead_band"},
                         .free_run = false});
  INFO(withheld.text);
  CHECK(withheld.code == 4);
  CHECK_THAT(withheld.text, Catch::Contains("left over   gearbox of extensor") &&
                                Catch::Contains("withheld    gearbox_coulomb, ") &&
                                Catch::Contains("next        erp gap plan --robot "));

  CHECK(diagnosed(folder, {.train = {rubs}, .held_out = {plain}}).code == 5);

  const Told all_train = diagnosed(folder, {.recordings = {rubs, again}, .train = {rubs, again}});
  CHECK(all_train.code == 5);
  CHECK_THAT(all_train.text,
             Catch::Contains("no recording is held out") && !Catch::Contains("one recording only"));
}

TEST_CASE("spindles that are all wrong alike are not taken for the sensor of the joint they move") {
  const RecordedRig folder;
  erp::Robot robot = erp::read_robot(rig_file);
  for (erp::Actuator& actuator : robot.actuators) actuator.spindle.radius_m /= 0.75;
  const std::string model = folder.path / "thick.xml";
  std::ofstream(model) << erp::write_robot(robot);
  const Told told = diagnosed(folder, {.robot = model,
                                       .recordings = {folder.recorded("one.csv", false, 1, 12)},
                                       .free_run = false});
  INFO(told.text);
  CHECK(told.code == 0);
  CHECK_THAT(told.text,
             Catch::Contains("which       spindle_radius on flexor  relative = -0.25") &&
                 Catch::Contains("which       spindle_radius on extensor  relative = -0.25") &&
                 Catch::Contains("on the rest of the recording"));
}

TEST_CASE("one recording too short to be split supports nothing, and says what it looks like") {
  const RecordedRig folder;
  const Told told = diagnosed(folder, {.recordings = {folder.recorded("short.csv", true, 1, 1.6)}});
  INFO(told.text);
  CHECK(told.code == 5);
  CHECK_THAT(told.text, Catch::Contains("perhaps     gearbox_") &&
                            Catch::Contains("it was not split") &&
                            Catch::Contains("on the data it was found on"));
  CHECK_FALSE(fs::exists(folder.found("robot.xml")));
  CHECK_THAT(folder.read("report.html"), Catch::Contains("judged by the recording that it was") &&
                                             Catch::Contains("<p>Perhaps:</p>") &&
                                             !Catch::Contains("held-out recordings"));
}

TEST_CASE("what wants mending is said once for all recordings, and no experiment is proposed") {
  const RecordedRig folder;
  std::vector<std::string> files;
  for (std::uint64_t seed : {1, 2}) {
    const std::string file = folder.recorded(std::to_string(seed) + ".csv", true, seed);
    scale_column(file, "extensor.voltage_V", -1);
    files.push_back(file);
  }
  const Told told = diagnosed(folder, {.recordings = files, .free_run = false});
  INFO(told.text);
  CHECK_THAT(told.text, Catch::Contains("mend first  " + files[0] + ", " + files[1] +
                                        ": extensor.voltage_V: its sign") &&
                            Catch::Contains("of recordings to be mended first") &&
                            !Catch::Contains("next        erp gap plan"));
}

TEST_CASE("no gap beside a column to be mended is not identifiable, not \"no gap\"") {
  const RecordedRig folder;
  std::vector<std::string> files;
  for (std::uint64_t seed : {1, 2}) {
    const std::string file = folder.recorded(std::to_string(seed) + ".csv", false, seed);
    scale_column(file, "flexor.current_A", 1000);
    files.push_back(file);
  }
  const Told told = diagnosed(folder, {.recordings = files, .free_run = false});
  INFO(told.text);
  CHECK(told.code == 5);
  CHECK_THAT(told.text,
             Catch::Contains("verdict     not_identifiable") && Catch::Contains("mend first  "));
}

TEST_CASE("the page lists the constants of a robot as built, those that are off first") {
  sim::diagnosis::Diagnosis d;
  d.verdict = sim::diagnosis::Verdict::supported;
  const erp::Robot robot = erp::read_robot(rig_file);
  CHECK_THAT(launch::gap::diagnosis_report(d, {}, robot), !Catch::Contains("<h2>Constants</h2>"));
  sim::diagnosis::ConstantEstimate off{.name = "resistance_ohm", .on = "flexor"};
  off.nominal = 0.5, off.tolerance = 0.01, off.value = 0.52, off.interval = {0.515, 0.525};
  off.determined = 0.9;
  auto open = off;
  open.name = "mass_kg", open.determined = 0.1;
  d.constants = {open, off}, d.as_built = robot;
  const std::string page = launch::gap::diagnosis_report(d, {}, robot);
  const auto all = page.find("All 2");
  REQUIRE(all != page.npos);
  CHECK(page.find("resistance_ohm") < all);
  CHECK(page.find("mass_kg") > all);
  CHECK_THAT(page, Catch::Contains("constants within their tolerances, none far off") &&
                       Catch::Contains("0.515 … 0.525") && Catch::Contains("not determined"));
}

TEST_CASE("a folder that cannot be made is refused first; a diagnosis that fails leaves none") {
  const RecordedRig folder;
  const auto one = folder.recorded("one.csv", false, 1);
  std::ostringstream out, remarks;
  launch::gap::DiagnoseOptions how{.robot = rig_file, .recordings = {one}};
  how.out = one + "/below_a_file";
  CHECK_THROWS_WITH(launch::gap::diagnose(how, out, remarks), Catch::Contains("cannot be made"));
  how.out = folder.path / "new/er", how.train = {one}, how.held_out = {one};
  CHECK_THROWS(launch::gap::diagnose(how, out, remarks));
  CHECK_FALSE(fs::exists(folder.path / "new"));
}

TEST_CASE("the report shows where, which and how far, and needs no other file") {
  const RecordedRig folder;
  diagnosed(folder,
            {.recordings = {folder.recorded("1.csv", true, 1), folder.recorded("2.csv", true, 2)}});
  const std::string report = folder.read("report.html");
  for (const char* part : {"<h2>Where</h2>", "<h2>Which</h2>", "% closed (", "Signatures",
                           "<h2>The simulator let run freely</h2>", "<h2>The worst moments</h2>",
                           "gearbox_coulomb on extensor", "1.csv", "2.csv"})
    CHECK_THAT(report, Catch::Contains(part));
  CHECK_THAT(report, !Catch::Contains("href=") && !Catch::Contains("src=") &&
                         !Catch::Contains("nan") && !Catch::Contains("inf"));

  const auto d = nlohmann::json::parse(folder.read("diagnosis.json"));
  const auto& first = d["effects"][0];
  CHECK(first["type"] == "gearbox_coulomb");
  const auto& interval = first["intervals"]["extra_Nm"];
  CHECK(interval[0] < 0.03);
  CHECK(interval[1] > 0.03);
  CHECK(d["gap"]["closed"] > 0.9);
  CHECK(d["gap"]["closed_interval"][0] <= d["gap"]["closed"]);
  for (const auto& [name, channel] : d["gap"]["channels"].items()) {
    INFO(name);
    CHECK(channel["closed"].is_null() == (name != "gearbox extensor"));
    CHECK(channel["driven_by"] > 0);
  }
}

TEST_CASE("what cannot be asked of recordings is refused, with the name that is wrong") {
  const RecordedRig folder;
  const auto one = folder.recorded("one.csv", false, 1), two = folder.recorded("two.csv", false, 2);
  CHECK_THROWS_WITH(diagnosed(folder, {.recordings = {one}, .withhold = {"no_such_effect"}}),
                    Catch::Contains("no_such_effect") && Catch::Contains("erp model effects"));
  CHECK_THROWS_WITH(diagnosed(folder, {.train = {one, two}, .held_out = {two}}),
                    Catch::Contains("two.csv") && Catch::Contains("both in"));
  CHECK_THROWS_WITH(diagnosed(folder, {.recordings = {one}, .held_out = {one}}),
                    Catch::Contains("leave some to train on"));
  CHECK_THROWS_WITH(diagnosed(folder, {.recordings = {one, two, one}}),
                    Catch::Contains("one.csv") && Catch::Contains("named twice"));
}

TEST_CASE("a model in the folder of a diagnosis is neither written over nor removed") {
  const RecordedRig folder;
  const auto plain = folder.recorded("plain.csv", false, 1);
  fs::create_directories(folder.path / "found");
  const std::string mine = folder.found("robot.xml");
  fs::copy_file(rig_file, mine);
  launch::gap::DiagnoseOptions how{.recordings = {plain}};
  CHECK_THROWS_WITH(diagnosed(folder, how), Catch::Contains("that no diagnosis wrote"));
  std::ostringstream out, remarks;
  how.robot = mine, how.out = folder.path / "found";
  CHECK_THROWS_WITH(launch::gap::diagnose(how, out, remarks),
                    Catch::Contains("is the model itself"));
  CHECK(folder.read("robot.xml") == [&] {
    std::ifstream in(rig_file);
    return std::string(std::istreambuf_iterator<char>(in), {});
  }());
}

#include "launch/gap/gap.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "interfaces/recording/csv.hpp"
#include "tests/sim/residuals/rig_recording.hpp"
#include "tests/sim/rigs.hpp"

namespace {

const std::string robot_file = rigs::config("hinge_rig/robot.xml");

/// A recording of the rig with these effects, as a CSV file.
std::string recorded(const std::string& name, const std::vector<erp::Effect>& effects) {
  erp::Robot robot = erp::read_robot(robot_file);
  robot.effects = effects;
  const auto file = (std::filesystem::temp_directory_path() / name).string();
  std::ofstream out(file);
  recording::write_csv(rig_recording::table_of_run(robot, {.seconds = 8}), out);
  return file;
}

std::string said_of(const std::vector<std::string>& files) {
  std::ostringstream out, remarks;
  CHECK(launch::gap::where(robot_file, files, out, remarks) == 0);
  CHECK(remarks.str().empty());
  return out.str();
}

}  // namespace

TEST_CASE("recordings of the robot as modelled show no gap, an effect shows its stage") {
  const auto plain = recorded("erp_gap_plain.csv", {});
  const auto rubs = recorded("erp_gap_rubs.csv",
                             {{{}, "gearbox_coulomb", "extensor", {{{}, "extra_Nm", "0.03"}}}});
  CHECK_THAT(said_of({plain}), Catch::Contains("no gap"));
  CHECK_THAT(said_of({rubs}), Catch::Contains("the gap is in: gearbox of extensor\n"));
  std::filesystem::remove(plain), std::filesystem::remove(rubs);
}

TEST_CASE("a stage without its signals is named, not passed over") {
  const auto file = recorded("erp_gap_less.csv", {});
  recording::Table table = recording::read_table(file);
  std::erase_if(table.columns, [](const auto& c) { return c.name == "flexor.shaft_rad"; });
  std::ofstream out(file);
  recording::write_csv(table, out);
  out.close();
  CHECK_THAT(said_of({file}),
             Catch::Contains("motor of flexor, gearbox of flexor, tendon of flexor") &&
                 Catch::Contains("no gap in the others"));
  std::filesystem::remove(file);
}

TEST_CASE("where nothing can be judged, the exit code says so as well") {
  const auto file = recorded("erp_gap_nothing.csv", {});
  recording::Table table = recording::read_table(file);
  for (auto& column : table.columns) column.values.resize(15);  // shorter than any window
  std::ofstream out(file);
  recording::write_csv(table, out);
  out.close();
  std::ostringstream said, remarks;
  CHECK(launch::gap::where(robot_file, {file}, said, remarks) == 5);
  CHECK_THAT(said.str(), Catch::Contains("nothing could be judged"));
  std::filesystem::remove(file);
}

TEST_CASE("what the sensors of a robot cannot tell apart is told without a recording") {
  std::ostringstream out, remarks, less;
  launch::gap::TwinsOptions options{.robot = robot_file, .seconds = 4};
  CHECK(launch::gap::twins(options, out, remarks) == 0);
  CHECK_THAT(out.str(), Catch::Contains("routing_pulley_radius on flexor"));
  options.without = {"tension"};
  CHECK(launch::gap::twins(options, less, remarks) == 0);
  CHECK_THAT(out.str(), Catch::Contains("tendon_kite_line"));
  CHECK_THAT(less.str(), !Catch::Contains("tendon_kite_line"));  // does not show
}

TEST_CASE("what several effects do together for one is told, and of what types is checked") {
  std::ostringstream out, remarks;
  launch::gap::TwinsOptions options{.robot = robot_file, .seconds = 4, .together = 2};
  CHECK(launch::gap::twins(options, out, remarks) == 0);
  CHECK_THAT(out.str(),
             Catch::Matches("[^]*sensor_joint_offset on elbow [^\n]* on [^\n]* \\+ [^]*"));
  options.withhold = {"sensor_joint_ofset"};
  CHECK_THROWS_WITH(launch::gap::twins(options, out, remarks),
                    Catch::Contains("did you mean \"sensor_joint_offset\""));
}

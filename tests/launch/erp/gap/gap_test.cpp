#include "launch/erp/gap/gap.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "interfaces/recording/csv.hpp"
#include "sim/gap/checks/column_checks.hpp"
#include "sim/gap/checks/table_checks.hpp"
#include "sim/gap/closed_loop/predicted_run.hpp"
#include "sim/gap/diagnosis/localization.hpp"
#include "tests/sim/gap/residuals/rig_recording.hpp"
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

std::string output_of(const std::vector<std::string>& files) {
  std::ostringstream out, remarks;
  CHECK(launch::gap::where(robot_file, files, out, remarks) == 0);
  CHECK(remarks.str().empty());
  return out.str();
}

void check_no_faults(const erp::Robot& robot, const sim::closed_loop::SetPoints& set_points) {
  const auto table = sim::closed_loop::predict_run(robot, set_points);
  std::vector<std::string> corrections;
  auto episode = sim::residuals::lay_out(table, robot, "run", corrections);
  CHECK(sim::checks::table_checks(table, robot, "run") == std::vector<std::string>{});
  CHECK(sim::checks::column_checks(episode, robot) == std::vector<std::string>{});
  CHECK_FALSE(sim::diagnosis::localize(robot, std::vector{episode}).empty());
  for (auto& signals : episode.actuators) signals.tension_N.clear();
  CHECK(sim::checks::column_checks(episode, robot) == std::vector<std::string>{});
}

/// Set points of length with an amplitude of 2 mm and a different frequency for each actuator.
sim::closed_loop::SetPoints sinusoidal_lengths(const erp::Robot& robot, double seconds) {
  sim::closed_loop::SetPoints set_points(static_cast<std::size_t>(500 * seconds));
  for (std::size_t k = 0; k < set_points.size(); ++k)
    for (std::size_t a = 0; a < robot.actuators.size(); ++a)
      set_points[k].push_back(
          {erp::Mode::length, 0.002 * std::sin(0.002 * double(k) * (4 + 0.1 * double(a)))});
  return set_points;
}

}  // namespace

TEST_CASE("no effect: no gap; Coulomb friction of a gearbox: a gap at that gearbox") {
  const auto no_gap = recorded("erp_gap_plain.csv", {});
  const auto friction = recorded("erp_gap_friction.csv",
                                 {{{}, "gearbox_coulomb", "extensor", {{{}, "extra_Nm", "0.03"}}}});
  CHECK_THAT(output_of({no_gap}), Catch::Contains("no gap"));
  CHECK_THAT(output_of({friction}), Catch::Contains("the gap is in: gearbox of extensor\n"));
  std::filesystem::remove(no_gap), std::filesystem::remove(friction);
}

TEST_CASE("stages whose signals are missing are listed as not evaluated") {
  const auto file = recorded("erp_gap_less.csv", {});
  recording::Table table = recording::read_table(file);
  std::erase_if(table.columns, [](const auto& c) { return c.name == "flexor.shaft_rad"; });
  std::ofstream out(file);
  recording::write_csv(table, out);
  out.close();
  CHECK_THAT(output_of({file}),
             Catch::Contains("motor of flexor, gearbox of flexor, tendon of flexor") &&
                 Catch::Contains("no gap in the other stages"));
  std::filesystem::remove(file);
}

TEST_CASE("without a stage to evaluate, the exit code is 5") {
  const auto file = recorded("erp_gap_nothing.csv", {});
  recording::Table table = recording::read_table(file);
  for (auto& column : table.columns) column.values.resize(15);  // shorter than any window
  std::ofstream out(file);
  recording::write_csv(table, out);
  out.close();
  std::ostringstream printed, remarks;
  CHECK(launch::gap::where(robot_file, {file}, printed, remarks) == 5);
  CHECK_THAT(printed.str(), Catch::Contains("no stage could be evaluated"));
  std::filesystem::remove(file);
}

TEST_CASE("simulated recordings of all prototypes are evaluated and have no suspicious column") {
  for (const char* name : {"hinge_rig", "twin_joint", "arm", "seven_dof"}) {
    const erp::Robot robot = erp::read_robot(rigs::config(std::string(name) + "/robot.xml"));
    for (int kind = 0; kind < sim::excitation_kinds; ++kind) {
      INFO(name << ", " << sim::excitation_name(robot, kind));
      check_no_faults(robot, sim::closed_loop::set_points_of(sim::excitation(robot, kind, 4, 1)));
    }
  }
  for (const char* name : {"ecce1", "ecce2", "ecce3", "ecce4"}) {
    INFO(name);
    const erp::Robot robot = erp::read_robot(rigs::config(std::string(name) + "/robot.xml"));
    check_no_faults(robot, sinusoidal_lengths(robot, 3));
  }
}

TEST_CASE("erp gap confounders lists indistinguishable effects without a recording") {
  std::ostringstream out, remarks, without_tension;
  launch::gap::IndistinguishableOptions options{.robot = robot_file, .seconds = 4};
  CHECK(launch::gap::list_indistinguishable(options, out, remarks) == 0);
  CHECK_THAT(out.str(), Catch::Contains("routing_pulley_radius on flexor"));
  options.without = {"tension"};
  CHECK(launch::gap::list_indistinguishable(options, without_tension, remarks) == 0);
  CHECK_THAT(out.str(), Catch::Contains("tendon_kite_line"));
  CHECK_THAT(without_tension.str(),
             !Catch::Contains("tendon_kite_line"));  // not visible without tension
}

TEST_CASE(
    "erp gap confounders --max-effects 2 lists sums of two effects; an unknown type is rejected") {
  std::ostringstream out, remarks;
  launch::gap::IndistinguishableOptions options{
      .robot = robot_file, .seconds = 4, .max_effects = 2};
  CHECK(launch::gap::list_indistinguishable(options, out, remarks) == 0);
  CHECK_THAT(out.str(),
             Catch::Matches("[^]*sensor_joint_offset on elbow [^\n]* on [^\n]* \\+ [^]*"));
  options.withhold = {"sensor_joint_ofset"};
  CHECK_THROWS_WITH(launch::gap::list_indistinguishable(options, out, remarks),
                    Catch::Contains("did you mean \"sensor_joint_offset\""));
}

TEST_CASE("a recording in which no signal changes is rejected with file, cause and remedy") {
  const auto file = recorded("erp_gap_dead.csv", {});
  recording::Table table = recording::read_table(file);
  for (auto& column : table.columns)
    if (column.name != "time_s" && !column.name.ends_with(".mode"))
      std::ranges::fill(column.values, 0.0);
  std::ofstream out(file);
  recording::write_csv(table, out);
  out.close();
  std::ostringstream printed, remarks;
  CHECK_THROWS_WITH(launch::gap::where(robot_file, {file}, printed, remarks),
                    Catch::Contains("no signal changes") && Catch::Contains("while it moves"));
  std::filesystem::remove(file);
}

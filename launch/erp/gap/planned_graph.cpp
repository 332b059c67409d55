#include "launch/erp/gap/planned_graph.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <sstream>
#include <stdexcept>

#include "interfaces/recording/csv.hpp"
#include "launch/erp/text/text_files.hpp"

namespace launch::gap {
namespace {

namespace fs = std::filesystem;

recording::Table trajectory_of(const sim::Excitation& excitation, const erp::Robot& robot) {
  // Every fifth sample; the component `reference` interpolates linearly between rows. Chosen.
  constexpr std::size_t row_step = 5;
  recording::Table table;
  table.columns.push_back({"time_s", {}});
  for (const erp::Actuator& a : robot.actuators)
    table.columns.push_back({a.name + ".mode", {}}),
        table.columns.push_back({a.name + ".reference", {}});
  for (std::size_t k = 0; k < excitation.reference.size(); k += row_step) {
    table.columns[0].values.push_back(excitation.period_s * double(k));
    for (std::size_t a = 0; a < robot.actuators.size(); ++a) {
      table.columns[1 + 2 * a].values.push_back(static_cast<double>(excitation.mode));
      table.columns[2 + 2 * a].values.push_back(excitation.reference[k][a]);
    }
  }
  return table;
}

/// First line of a planned graph; it shows that erp gap plan wrote the file.
constexpr const char* first_line = "<!-- By erp gap plan. -->";

}  // namespace

void remove_earlier_plan(const std::string& out) {
  const std::string graph = out + "/graph.xml";
  const bool is_own_plan = fs::exists(graph) && read_text(graph).starts_with(first_line);
  for (const char* name : {"graph.xml", "reference.xml", "trajectory.csv"}) {
    const std::string file = fs::path(out) / name;
    if (!is_own_plan && fs::exists(file))
      throw std::invalid_argument("--out " + out + ": contains a " + name +
                                  " that erp gap plan did not write; choose another folder");
    fs::remove(file);
  }
}

void write_graph(const std::string& out, const std::string& robot_file, const erp::Robot& robot,
                 const sim::Excitation& excitation) {
  make_folder(out);
  std::ostringstream csv;
  recording::write_csv(trajectory_of(excitation, robot), csv);
  write_file(out + "/trajectory.csv", csv.str());
  write_file(out + "/reference.xml", "<reference file=\"trajectory.csv\"/>\n");
  constexpr std::size_t max_name = 20;  // leaves room for "_next" in a name of 32 characters
  const auto robot_path = fs::relative(fs::absolute(robot_file), fs::absolute(out));
  write_file(out + "/graph.xml",
             fmt::format("{}\n<graph name=\"{}_next\" robot=\"{}\" device=\"sim\">\n"
                         "  <component name=\"reference\" config=\"reference.xml\"/>\n"
                         "  <component name=\"logger\"/>\n</graph>\n",
                         first_line, robot.name.substr(0, max_name), robot_path.string()));
}

}  // namespace launch::gap

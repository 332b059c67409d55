#include "launch/erp/inspect/check.hpp"

#include <filesystem>
#include <ostream>
#include <set>
#include <stdexcept>
#include <system_error>

#include "hal/can/load.hpp"
#include "interfaces/graph/graph.hpp"
#include "interfaces/robot/robot.hpp"
#include "interfaces/xml/xml.hpp"
#include "launch/erp/gap/gap.hpp"
#include "launch/erp/run/input_sources.hpp"
#include "launch/erp/verbs/component_check.hpp"
#include "sim/control/loop_shaping/joint_loops.hpp"
#include "sim/learning/calibration/parameters.hpp"
#include "sim/learning/experience/base_file.hpp"
#include "sim/learning/experience/task.hpp"
#include "sim/learning/muscle_networks/learned_lengths.hpp"
#include "sim/learning/sensorimotor/learned_map_file.hpp"
#include "sim/learning/synergy/task.hpp"
#include "sim/model/cameras/view.hpp"
#include "sim/model/effects/library.hpp"

namespace launch {
namespace {

/// Checks files and the files that a graph names. Checks each file only once.
class Checker {
 public:
  Checker(std::ostream& out, const CheckComponent& component) : out_(out), component_(component) {}

  void check(const std::string& file) {
    std::error_code ignored;
    if (!checked_files_.insert(std::filesystem::weakly_canonical(file, ignored).string()).second)
      return;
    try {
      check_as(xml::read_document(file), file);
    } catch (const xml::Errors& errors) {
      print_errors(errors.what());
    } catch (const std::invalid_argument& error) {
      print_errors(file + ": " + error.what());
    }
  }
  int exit_code() const { return is_valid_ ? 0 : 2; }

 private:
  void check_as(const xml::Element& root, const std::string& file) {
    if (root.name == erp::Robot::element) {
      const erp::Robot robot = erp::read_robot(file);
      sim::effects::equip(robot);
      launch::gap::read_chains(file);  // throws if a tolerance matches no constant
      erp::refuse_overload(robot);
      print_ok(file);
      if (!robot.can_buses.empty())
        for (const erp::BusLoad& load : erp::bus_loads(robot))
          out_ << "  bus " << to_string(load) << '\n';
    } else if (root.name == erp::Graph::element) {
      const erp::Graph graph = erp::read_graph(file);
      check_input_sources(graph, {});
      print_ok(file);
      check(graph.robot);
      for (const erp::GraphComponent& component : graph.components)
        if (!component.config.empty()) check(component.config);
    } else if (reads_as_one_of<sim::calibration::Choice, sim::cameras::ViewConfig,
                               sim::muscle_networks::LearnedMuscles, sim::loop_shaping::JointShape,
                               sim::sensorimotor::LearnedMapFile, sim::experience::Task,
                               sim::experience::BaseFile, sim::synergy::Task,
                               sim::synergy::BankFile>(root.name, file)) {
      print_ok(file);
    } else {
      check_config(root, file);
    }
  }

  /// If the root element is that of one of the types `Kind`, reads the file as that type and
  /// returns true. Throws xml::Errors.
  template <class... Kind>
  bool reads_as_one_of(const std::string& root, const std::string& file) {
    return ((xml::is_element_name<Kind>(root) && (xml::read<Kind>(file), true)) || ...);
  }

  void check_config(const xml::Element& root, const std::string& file) {
    const auto errors = component_ ? component_(root.name, file) : std::nullopt;
    if (!errors)
      print_errors(to_string(
          xml::error_in(root.name, root.place, "no component of this type is installed",
                        xml::did_you_mean(root.name, {erp::Robot::element, erp::Graph::element}) +
                            ", or the type of a component")));
    else if (!errors->empty()) print_errors(*errors);
    else print_ok(file);
  }

  void print_ok(const std::string& file) { out_ << file << ": ok\n"; }
  void print_errors(const std::string& lines) {
    is_valid_ = false;
    out_ << lines << (lines.ends_with('\n') ? "" : "\n");
  }

  std::ostream& out_;
  const CheckComponent& component_;
  std::set<std::string> checked_files_;
  bool is_valid_ = true;
};

}  // namespace

CheckComponent check_by_program(std::function<std::string(const std::string&)> find) {
  return [find = std::move(find)](const std::string& type,
                                  const std::string& file) -> std::optional<std::string> {
    const std::string program = find(type);
    if (program.empty()) return std::nullopt;
    return check_component({program, "--config", file});
  };
}

int check(const std::vector<std::string>& files, std::ostream& out,
          const CheckComponent& component) {
  Checker checker(out, component);
  for (const std::string& file : files) checker.check(file);
  return checker.exit_code();
}

void print_schema(const std::string& kind, std::ostream& out) {
  if (kind == erp::Robot::element) out << xml::schema<erp::Robot>();
  else if (kind == erp::Graph::element) out << xml::schema<erp::Graph>();
  else
    throw xml::Errors({{{"--schema " + kind, 0, 0},
                        "no schema has this name",
                        xml::did_you_mean(kind, {erp::Robot::element, erp::Graph::element})}});
}

}  // namespace launch

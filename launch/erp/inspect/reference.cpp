#include "launch/erp/inspect/reference.hpp"

#include <filesystem>
#include <map>
#include <ostream>
#include <sstream>
#include <stdexcept>

#include "interfaces/graph/graph.hpp"
#include "interfaces/robot/robot.hpp"
#include "interfaces/xml/words.hpp"
#include "interfaces/xml/xml.hpp"
#include "sim/control/loop_shaping/joint_loops.hpp"
#include "sim/learning/calibration/parameters.hpp"
#include "sim/learning/experience/base_file.hpp"
#include "sim/learning/experience/task.hpp"
#include "sim/learning/muscle_networks/learned_lengths.hpp"
#include "sim/learning/sensorimotor/learned_map_file.hpp"
#include "sim/learning/synergy/task.hpp"
#include "sim/model/cameras/view.hpp"

namespace launch {
namespace {

using Describe = std::string (*)();

template <class... Kind>
std::map<std::string, Describe> formats_of() {
  return {{Kind::element, &xml::describe<Kind>}...};
}

const std::map<std::string, Describe> main_formats = formats_of<erp::Robot, erp::Graph>();

/// Formats of the files that configs of components and verbs refer to.
const std::map<std::string, Describe> named_files =
    formats_of<sim::loop_shaping::JointShape, sim::cameras::ViewConfig,
               sim::muscle_networks::LearnedMuscles, sim::sensorimotor::LearnedMapFile,
               sim::experience::Task, sim::experience::BaseFile, sim::synergy::Task,
               sim::synergy::BankFile, sim::calibration::Choice>();

const Describe* find(const std::string& name) {
  for (const auto* formats : {&main_formats, &named_files})
    if (const auto format = formats->find(name); format != formats->end()) return &format->second;
  return nullptr;
}

std::vector<std::string> names_of(const std::map<std::string, Describe>& formats) {
  std::vector<std::string> names;
  for (const auto& [name, describe] : formats) names.push_back(name);
  return names;
}

/// The names, wrapped to lines of at most 100 columns that begin at column 19.
std::string wrapped(const std::vector<std::string>& names) {
  constexpr std::size_t indent = 19, width = 100;
  std::string text;
  std::size_t column = indent;
  for (const auto& name : names) {
    if (column + 1 + name.size() > width) text += "\n" + std::string(column = indent, ' ');
    else if (column > indent) text += ' ', ++column;
    text += name, column += name.size();
  }
  return text;
}

[[noreturn]] void throw_unknown_name(const std::string& name) {
  auto valid_names = component_names();
  for (const auto& names : {names_of(main_formats), names_of(named_files)})
    valid_names.insert(valid_names.end(), names.begin(), names.end());
  throw std::invalid_argument("help: no XML format, component or verb \"" + name + "\"; " +
                              xml::did_you_mean(name, valid_names) + "; erp help lists all");
}

}  // namespace

void print_reference(const std::string& name, const DescribeComponent& describe,
                     std::ostream& out) {
  const char* columns = "Columns: name, type with range, unit, default, description.\n\n";
  if (const Describe* format = find(name)) {
    out << "<" << name << ">: attributes, and elements in <>, indented below their element.\n"
        << columns << (*format)();
    return;
  }
  const auto table = describe(name);
  if (!table) throw_unknown_name(name);
  const std::string type = std::filesystem::path(name).filename().string();
  out << type << ": parameters of a component, as attributes of <" << type
      << "> in its config or by --set " << type << ".PARAMETER=VALUE of erp launch.\n"
      << columns << *table;
}

void list_references(std::ostream& out) {
  out << "erp help NAME explains\n"
      << "  XML formats      " << wrapped(names_of(main_formats)) << '\n'
      << "  components       " << wrapped(component_names()) << '\n'
      << "  files they name  " << wrapped(names_of(named_files)) << '\n'
      << "  verbs            as erp VERB --help\n";
}

std::vector<std::string> component_names() {
  std::vector<std::string> names;
  std::istringstream stream(ERP_COMPONENTS);
  for (std::string name; stream >> name;) names.push_back(name);
  return names;
}

}  // namespace launch

#include "interfaces/graph/graph.hpp"

#include <filesystem>
#include <map>

#include "interfaces/xml/xml.hpp"

namespace erp {
namespace {

/// Bound of the string `component` in the IDL of the messages; a test compares both values.
constexpr std::size_t max_component_name_length = 32;

void resolve(std::string& file, const std::string& graph_file) {
  if (!file.empty()) file = xml::resolved(file, graph_file);
}

/// Checks file names before they are resolved: errors then quote the text of the graph.
class Check {
 public:
  explicit Check(const Graph& graph) : graph_(graph) {}

  std::vector<xml::Error> run() {
    check_file(graph_, "robot", graph_.robot);
    check_root(graph_, "robot", graph_.robot, "robot");
    check_device();
    for (const GraphComponent& component : graph_.components) check(component);
    return std::move(errors_);
  }

 private:
  template <class Item>
  void add(const Item& item, const std::string& what, const std::string& remedy) {
    errors_.push_back(xml::error_in(Item::element, item.place, what, remedy));
  }

  std::string path_of(const std::string& file) const {
    return xml::resolved(file, graph_.place.file);
  }

  template <class Item>
  bool check_file(const Item& item, const std::string& attribute, const std::string& file) {
    if (std::filesystem::is_regular_file(path_of(file))) return true;
    add(item, attribute + "=" + xml::quote(file) + " is not a file",
        "looked for " + path_of(file) + "; paths are relative to the graph file");
    return false;
  }

  /// Checks only the root element; the reader of that file checks the rest.
  template <class Item>
  void check_root(const Item& item, const std::string& attribute, const std::string& file,
                  const std::string& expected) {
    if (!std::filesystem::is_regular_file(path_of(file))) return;
    try {
      const std::string root = xml::read_document(path_of(file)).name;
      if (root != expected)
        add(item, attribute + "=" + xml::quote(file) + " contains <" + root + ">",
            "it must contain <" + expected + ">; otherwise change the type to \"" + root + "\"");
    } catch (const xml::Errors& errors) {
      errors_.insert(errors_.end(), errors.all().begin(), errors.all().end());
    }
  }

  void check_device() {
    if (graph_.device == Device::replay && graph_.replay.empty())
      add(graph_, "device=\"replay\" has no recording", "add replay=\"recording.mcap\"");
    if (graph_.device == Device::replay && !graph_.replay.empty())
      check_file(graph_, "replay", graph_.replay);
    if (!graph_.bus.starts_with("socketcan:") && !graph_.bus.starts_with("udp:"))
      add(graph_, "bus=" + xml::quote(graph_.bus) + " is not a CAN bus",
          "write socketcan:INTERFACE or udp:GROUP:PORT");
    if (graph_.device == Device::can && graph_.hardware && graph_.time == Time::lockstep)
      add(graph_, "time=\"lockstep\" with hardware=\"true\": hardware cannot run in lockstep",
          "write time=\"wall\", or remove hardware");
  }

  void check(const GraphComponent& component) {
    const auto [first, is_new] = place_of_name_.emplace(component.name, component.place);
    if (!is_new)
      add(component, "duplicate name " + xml::quote(component.name),
          "give this one its own name and set type=\"…\"; the first is in line " +
              std::to_string(first->second.line));
    if (component.name.size() > max_component_name_length)
      add(component,
          "name=" + xml::quote(component.name) + " has " + std::to_string(component.name.size()) +
              " characters",
          "the bus allows at most " + std::to_string(max_component_name_length));
    if (component.config.empty() || !check_file(component, "config", component.config)) return;
    const std::string& type = component.type.empty() ? component.name : component.type;
    check_root(component, "config", component.config,
               std::filesystem::path(type).filename().string());  // a type may be a path
  }

  const Graph& graph_;
  std::map<std::string, xml::Place> place_of_name_;
  std::vector<xml::Error> errors_;
};

}  // namespace

Graph read_graph(const std::string& file) {
  Graph graph = xml::read<Graph>(file);
  xml::throw_if_any(Check(graph).run());
  resolve(graph.robot, file);
  resolve(graph.replay, file);
  for (GraphComponent& component : graph.components) resolve(component.config, file);
  return graph;
}

}  // namespace erp

#include "launch/erp/run/input_sources.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "interfaces/xml/document.hpp"

namespace launch {
namespace {

/// A parameter that names the source of an input. `of_simulator`: its value, also by default, that
/// means the simulator.
struct SourceParameter {
  const char* type;
  const char* parameter;
  const char* of_simulator;
  const char* input;
};
constexpr std::array source_parameters{
    SourceParameter{"computed_force", "source", "sim", "joint angles"},
    SourceParameter{"puller_follower", "source", "sim", "joint angles"},
    SourceParameter{"experience", "source", "sim", "joint angles"},
    SourceParameter{"joint_target", "source", "sim", "joint angles"},
    SourceParameter{"synergy", "source", "sim", "body poses"},
    SourceParameter{"motion_capture", "images", "", "images"},
    SourceParameter{"eye", "images", "", "images"},
};

/// Value of a parameter: setting, config, or the default.
std::string value_of(const erp::GraphComponent& component, const SourceParameter& source,
                     const std::vector<Setting>& settings) {
  for (const Setting& setting : settings)
    if (setting.component == component.name && setting.key == source.parameter)
      return setting.value;
  if (component.config.empty()) return source.of_simulator;
  for (const auto& attribute : xml::read_document(component.config).attributes)
    if (attribute.name == source.parameter) return attribute.value;
  return source.of_simulator;
}

bool runs(const erp::Graph& graph, const std::string& name) {
  return std::ranges::find(graph.components, name, &erp::GraphComponent::name) !=
         graph.components.end();
}

std::string remedy_of(const SourceParameter& source) {
  if (std::string_view(source.parameter) == "images")
    return "set images to the files of its cameras";
  if (std::string_view(source.input) == "body poses")
    return "add a <component> motion_capture, and set source to its name";
  return "add a <component> pose_estimator or motion_capture, and set source to its name";
}

}  // namespace

void check_input_sources(const erp::Graph& graph, const std::vector<Setting>& settings) {
  if (graph.device != erp::Device::can || !graph.hardware) return;
  std::vector<xml::Error> errors;
  for (const erp::GraphComponent& component : graph.components)
    for (const SourceParameter& source : source_parameters) {
      if (type_of(component) != source.type) continue;
      const std::string value = value_of(component, source, settings);
      const bool is_image_file = std::string_view(source.parameter) == "images" && !value.empty();
      if (is_image_file || (value != source.of_simulator && runs(graph, value))) continue;
      const std::string publisher =
          value == source.of_simulator ? "the simulator" : "\"" + value + "\"";
      errors.push_back(
          xml::error_in(erp::GraphComponent::element, component.place,
                        "component \"" + component.name + "\" gets its " + source.input + " from " +
                            publisher + ", which does not run in this graph with hardware=\"true\"",
                        remedy_of(source)));
    }
  if (!errors.empty()) throw xml::Errors(errors);
}

}  // namespace launch

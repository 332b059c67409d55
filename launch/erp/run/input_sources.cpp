#include "launch/erp/run/input_sources.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "interfaces/xml/document.hpp"

namespace launch {
namespace {

/// A parameter that names the source of an input. `of_simulator`: its value, also by default, that
/// means the simulator. If that is empty, other values name files, otherwise a component.
struct SourceParameter {
  const char *type, *parameter, *of_simulator, *input, *remedy;
};
constexpr auto angles_remedy =
    "add a <component> pose_estimator or motion_capture, and set source to its name";
constexpr auto images_remedy = "set images to the files of its cameras";
constexpr std::array source_parameters{
    SourceParameter{"computed_force", "source", "sim", "joint angles", angles_remedy},
    SourceParameter{"puller_follower", "source", "sim", "joint angles", angles_remedy},
    SourceParameter{"experience", "source", "sim", "joint angles", angles_remedy},
    SourceParameter{"joint_target", "source", "sim", "joint angles", angles_remedy},
    SourceParameter{"synergy", "source", "sim", "body poses",
                    "add a <component> motion_capture, and set source to its name"},
    SourceParameter{"motion_capture", "images", "", "images", images_remedy},
    SourceParameter{"eye", "images", "", "images", images_remedy},
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

bool is_available(const erp::Graph& graph, const SourceParameter& source,
                  const std::string& value) {
  if (value == source.of_simulator) return false;
  const bool is_file = !*source.of_simulator;
  return is_file || std::ranges::find(graph.components, value, &erp::GraphComponent::name) !=
                        graph.components.end();
}

}  // namespace

void check_input_sources(const erp::Graph& graph, const std::vector<Setting>& settings) {
  if (graph.device != erp::Device::can || !graph.hardware) return;
  std::vector<xml::Error> errors;
  for (const erp::GraphComponent& component : graph.components)
    for (const SourceParameter& source : source_parameters) {
      if (type_of(component) != source.type) continue;
      const std::string value = value_of(component, source, settings);
      if (is_available(graph, source, value)) continue;
      const std::string publisher =
          value == source.of_simulator ? "the simulator" : "\"" + value + "\"";
      errors.push_back(
          xml::error_in(erp::GraphComponent::element, component.place,
                        "component \"" + component.name + "\" gets its " + source.input + " from " +
                            publisher + ", which does not run in this graph with hardware=\"true\"",
                        source.remedy));
    }
  if (!errors.empty()) throw xml::Errors(errors);
}

}  // namespace launch

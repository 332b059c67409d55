#pragma once
#include <functional>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

/// `erp help NAME`: reference of XML formats and components, from the same descriptions as reader
/// and XSD.
namespace launch {

/// The table of parameters that the program of a component prints with --describe; nullopt: there
/// is no such program.
using DescribeComponent = std::function<std::optional<std::string>(const std::string& type)>;

/// Prints every element and attribute of robot.xml (`robot`), of a graph (`graph`), of a file that
/// a config or a verb names (`loops`, `camera_view` …), or every parameter of a component: name,
/// type with range, unit, default, description. Throws std::invalid_argument for another name.
void print_reference(const std::string& name, const DescribeComponent& describe, std::ostream& out);

/// Prints the names that print_reference accepts.
void list_references(std::ostream& out);

/// The programs of components that belong to erp.
std::vector<std::string> component_names();

}  // namespace launch

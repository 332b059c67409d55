#pragma once
#include <string>
#include <vector>

/// Search for the programs of components.
namespace launch {

/// The folder of the running `erp`.
std::string own_folder();

/// The program of a component type; "" if there is none. A type with a slash is a path relative to
/// `graph_folder`. Other types are searched in $ERP_COMPONENT_PATH; then, if `erp` is installed, in
/// `../libexec/erp` relative to it, otherwise in the folder of `erp`; then in $PATH.
std::string find_program(const std::string& type, const std::string& graph_folder);

/// The programs of components that belong to this `erp`.
std::vector<std::string> own_programs();

}  // namespace launch

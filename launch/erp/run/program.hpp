#pragma once
#include <string>
#include <vector>

/// Where a component's program lies.
namespace launch {

/// The folder of the running `erp` itself.
std::string own_folder();

/// The program of a component type. A type with a slash is a path, relative to `graph_folder`;
/// otherwise these are searched: $ERP_COMPONENT_PATH, the folder of `erp`, `../libexec/erp` beside
/// it, $PATH. Returns "" when there is none.
std::string find_program(const std::string& type, const std::string& graph_folder);

/// What stands beside erp, without erp itself.
std::vector<std::string> own_programs();

}  // namespace launch

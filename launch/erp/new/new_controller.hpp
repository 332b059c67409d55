#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <vector>

/// `erp new controller NAME DIR`: creates a project of one controller that is built against the
/// installed package.
namespace launch {

/// A file of launch/erp/new/templates/controller, compiled into `erp`, with the placeholders
/// `@name@` and `@Class@`.
struct Template {
  const char* file;
  const char* text;
};
std::span<const Template> controller_templates();

/// `tension_hold` → `TensionHold`.
std::string class_name(const std::string& snake_case_name);

/// Writes the project and returns its files. `folder` must be empty or must not exist. Throws
/// std::invalid_argument for a name that is not snake_case, is too long for the bus, or is the name
/// of an existing component; std::runtime_error if a file cannot be written.
std::vector<std::filesystem::path> new_controller(const std::string& name,
                                                  const std::filesystem::path& folder);

}  // namespace launch

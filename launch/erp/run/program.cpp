#include "launch/erp/run/program.hpp"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <vector>

namespace launch {
namespace fs = std::filesystem;
namespace {

bool is_program(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error) && access(path.c_str(), X_OK) == 0;
}

void append_folders(std::vector<fs::path>& folders, const char* variable) {
  const char* value = std::getenv(variable);
  std::istringstream stream(value ? value : "");
  for (std::string folder; std::getline(stream, folder, ':');)
    if (!folder.empty()) folders.emplace_back(folder);
}

}  // namespace

std::string own_folder() { return fs::read_symlink("/proc/self/exe").parent_path().string(); }

/// The components of an installed `erp` are in ../libexec/erp, those of a build tree in the folder
/// of `erp`. The folder of an installed `erp` is not searched: /usr/bin contains other programs
/// with the same names, such as Debian's logger.
static fs::path component_folder() {
  const fs::path erp_folder = own_folder(),
                 installed_components = erp_folder.parent_path() / "libexec" / "erp";
  return fs::is_directory(installed_components) ? installed_components : erp_folder;
}

std::string find_program(const std::string& type, const std::string& graph_folder) {
  if (type.find('/') != type.npos) {
    const fs::path path = fs::path(graph_folder) / type;
    return is_program(path) ? fs::absolute(path).lexically_normal().string() : "";
  }
  std::vector<fs::path> folders;
  append_folders(folders, "ERP_COMPONENT_PATH");
  folders.push_back(component_folder());
  append_folders(folders, "PATH");
  for (const auto& folder : folders)
    if (is_program(folder / type)) return fs::absolute(folder / type).string();
  return "";
}

std::vector<std::string> own_programs() {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(component_folder(), ignored))
    if (is_program(entry.path()) && entry.path().filename() != "erp")
      names.push_back(entry.path().filename().string());
  return names;
}

}  // namespace launch

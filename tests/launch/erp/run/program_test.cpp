#include "launch/erp/run/program.hpp"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace fs = std::filesystem;

namespace {

/// A folder with one executable `my_component`. Unsets $ERP_COMPONENT_PATH at the end.
struct Programs {
  fs::path path;
  Programs() {
    std::string name = (fs::temp_directory_path() / "erp_program_XXXXXX").string();
    path = mkdtemp(name.data());
    std::ofstream(path / "my_component") << "#!/bin/sh\n";
    fs::permissions(path / "my_component", fs::perms::owner_all);
    std::ofstream(path / "not_executable") << "text";
  }
  ~Programs() {
    unsetenv("ERP_COMPONENT_PATH");
    fs::remove_all(path);
  }
};

}  // namespace

TEST_CASE("find_program finds an executable in ERP_COMPONENT_PATH") {
  const Programs programs;
  CHECK(launch::find_program("my_component", ".").empty());
  setenv("ERP_COMPONENT_PATH", ("/nowhere:" + programs.path.string()).c_str(), 1);
  CHECK(launch::find_program("my_component", ".") == programs.path / "my_component");
  CHECK(launch::find_program("not_executable", ".").empty());
}

TEST_CASE("a type with a slash is a path relative to the graph") {
  const Programs programs;
  CHECK(launch::find_program("./my_component", programs.path) == programs.path / "my_component");
  CHECK(launch::find_program("./other", programs.path).empty());
}

TEST_CASE("programs in the folder of erp precede those of PATH") {
  CHECK(launch::find_program("launch_test", ".") == launch::own_folder() + "/launch_test");
  CHECK_FALSE(launch::find_program("sh", ".").empty());
}

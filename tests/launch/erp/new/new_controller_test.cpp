#include "launch/erp/new/new_controller.hpp"

#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <sstream>
#include <stdexcept>

using Catch::Matchers::Contains;
namespace fs = std::filesystem;

namespace {

struct Folder {
  fs::path path;
  Folder() {
    std::string name = (fs::temp_directory_path() / "erp_new_XXXXXX").string();
    path = mkdtemp(name.data());
  }
  ~Folder() { fs::remove_all(path); }
};

std::string text_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

}  // namespace

TEST_CASE("class_name converts snake_case to PascalCase") {
  CHECK(launch::class_name("tension_hold") == "TensionHold");
  CHECK(launch::class_name("p2_loop") == "P2Loop");
}

TEST_CASE("new_controller writes a complete project without placeholders") {
  const Folder folder;
  const auto files = launch::new_controller("tension_hold", folder.path / "mine");
  for (const char* file : {"CMakeLists.txt", "tension_hold.hpp", "main.cpp", "tension_hold.xml",
                           "tension_hold_test.cpp", "README.md"})
    CHECK(fs::exists(folder.path / "mine" / file));
  CHECK(files.size() == 6);
  for (const auto& file : files) {
    INFO(file);
    CHECK_THAT(text_of(file), !Contains("@"));
  }
  CHECK_THAT(text_of(folder.path / "mine" / "main.cpp"),
             Contains("\"tension_hold.hpp\"") && Contains("node::run<TensionHold>(argc, argv)"));
}

TEST_CASE("the controller file has at most thirty lines") {
  const Folder folder;
  launch::new_controller("tension_hold", folder.path);
  const auto text = text_of(folder.path / "tension_hold.hpp");
  CHECK(std::count(text.begin(), text.end(), '\n') <= 30);
}

TEST_CASE("an invalid name is rejected with the reason, and no file is written") {
  const Folder folder;
  const fs::path target = folder.path / "mine";
  for (const char* name : {"", "MyController", "my-controller", "2fast", "a__b", "end_", "../x"})
    CHECK_THROWS_WITH(launch::new_controller(name, target), Contains("lower-case words"));
  CHECK_THROWS_WITH(launch::new_controller("class", target), Contains("C++"));
  CHECK_THROWS_WITH(launch::new_controller("plant", target), Contains("exists already"));
  CHECK_THROWS_WITH(launch::new_controller(std::string(33, 'a'), target), Contains("32"));
  CHECK_FALSE(fs::exists(target));
}

TEST_CASE("a folder that is not empty is rejected and not changed") {
  const Folder folder;
  std::ofstream(folder.path / "precious") << "mine";
  CHECK_THROWS_WITH(launch::new_controller("tension_hold", folder.path),
                    Contains("exists already"));
  CHECK(text_of(folder.path / "precious") == "mine");
}

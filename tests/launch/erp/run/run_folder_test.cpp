#include "launch/erp/run/run_folder.hpp"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace fs = std::filesystem;
using Strings = std::vector<std::string>;

namespace {

/// A temporary folder as current folder.
struct TemporaryCurrentFolder {
  fs::path previous_path = fs::current_path(), path;
  TemporaryCurrentFolder() {
    std::string name = (fs::temp_directory_path() / "erp_folder_XXXXXX").string();
    path = mkdtemp(name.data());
    fs::current_path(path);
  }
  ~TemporaryCurrentFolder() {
    fs::current_path(previous_path);
    fs::remove_all(path);
  }
};

constexpr std::int64_t new_year_ns = 1'735'689'600'000'000'000;  // 2025-01-01T00:00:00Z

}  // namespace

TEST_CASE("the run folder has the names of graph and start time") {
  const TemporaryCurrentFolder here;
  CHECK(launch::make_run_folder("", "rig", new_year_ns) ==
        fs::canonical(here.path) / "erp_runs/rig/2025-01-01T00-00-00Z");
}

TEST_CASE("two runs in the same second have different folders") {
  const TemporaryCurrentFolder here;
  launch::make_run_folder("", "rig", new_year_ns);
  CHECK(fs::path(launch::make_run_folder("", "rig", new_year_ns)).filename() ==
        "2025-01-01T00-00-00Z-2");
}

TEST_CASE("a folder that cannot be created is rejected with the option --out") {
  const TemporaryCurrentFolder here;
  std::ofstream("file") << "";
  CHECK_THROWS_WITH(launch::make_run_folder("file/run", "rig", 0),
                    Catch::Matchers::Contains("--out DIR"));
}

TEST_CASE("a folder locked by a run is rejected") {
  const TemporaryCurrentFolder folder;
  {
    const launch::FolderLock lock(folder.path.string());
    CHECK_THROWS_WITH(launch::FolderLock(folder.path.string()), Catch::Contains("another run"));
  }
  CHECK_NOTHROW(launch::FolderLock(folder.path.string()));
}

TEST_CASE("last_lines returns the last lines of a file, or all of a short file") {
  const TemporaryCurrentFolder here;
  std::ofstream("log") << "a\nb\nc\n";
  CHECK(launch::last_lines("log", 2) == Strings{"b", "c"});
  CHECK(launch::last_lines("log", 9) == Strings{"a", "b", "c"});
  CHECK(launch::last_lines("nowhere", 9).empty());
}

// An installed erp: its components are in ../libexec/erp. Its own folder contains other programs.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "tests/system/command.hpp"

using namespace tests;
namespace fs = std::filesystem;

TEST_CASE(
    "an installed erp starts its own components, not other programs of the same name in its "
    "folder") {
  const Folder folder;
  const fs::path bin = folder / "bin", components = folder / "libexec/erp";
  fs::create_directories(bin), fs::create_directories(components);
  fs::copy_file(ERP_BIN_DIR "/erp", bin / "erp");
  for (const char* name : {"sim", "plant", "logger", "reference", "target", "force_control"}) {
    fs::create_symlink(fs::path(ERP_BIN_DIR) / name, components / name);
    std::ofstream(bin / name)
        << "#!/bin/sh\nexit 9\n";  // another program, like Debian's /usr/bin/logger
    fs::permissions(bin / name, fs::perms::owner_all);
  }
  const auto outcome =
      run((bin / "erp").string() + " launch launch/force_step.xml --lockstep --for 100ms --out " +
          (folder / "run"));
  INFO(outcome.output);
  CHECK(outcome.exit_code == 0);
  CHECK(fs::exists(folder / "run/force_step.mcap"));
}

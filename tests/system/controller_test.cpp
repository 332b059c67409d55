// A user's controller is generated, built against the installed package, tested and attached to a
// running graph.
#include <catch2/catch.hpp>

#include "tests/system/background.hpp"

using namespace tests;
namespace fs = std::filesystem;

TEST_CASE("a new controller builds out of tree, passes its test and drives a running robot") {
  Folder folder;
  const auto prefix = folder / "erp", project = folder / "my_controller";
  REQUIRE(run("cmake --install " ERP_BUILD_DIR " --prefix " + prefix).exit_code == 0);
  CHECK(content(prefix + "/share/man/man1/erp.1").starts_with(".\\\""));
  CHECK(fs::exists(prefix + "/share/bash-completion/completions/erp"));
  REQUIRE(run("erp new controller my_controller " + project).exit_code == 0);
  const auto build =
      run("cmake -S " + project + " -B " + project + "/build -DCMAKE_PREFIX_PATH=" + prefix +
          " -DCMAKE_CXX_FLAGS='" ERP_CXX_FLAGS "' && cmake --build " + project + "/build");
  INFO(build.output);
  REQUIRE(build.exit_code == 0);
  const auto test = run("ctest --test-dir " + project + "/build --output-on-failure");
  INFO(test.output);
  REQUIRE(test.exit_code == 0);

  // The graph has only logger, plant and simulator; no controller sends commands.
  Background graph({"launch", "launch/idle.xml", "--out", folder / "run"}, folder / "run.txt");
  REQUIRE(graph.wait_for_output("all components are active"));
  const auto attached = run("timeout --signal=INT 3 " + project + "/build/my_controller --robot " +
                            prefix + "/share/erp/configs/hinge_rig/robot.xml");
  INFO(attached.output);
  CHECK(graph.wait_for_output("driven by my_controller"));
  CHECK(graph.stop() == 0);
}

TEST_CASE("the user's part of a new controller has at most 30 lines") {
  Folder folder;
  const auto project = folder / "lean";
  REQUIRE(run("erp new controller lean " + project).exit_code == 0);
  const auto header = content(project + "/lean.hpp");
  CHECK(std::count(header.begin(), header.end(), '\n') <= 30);
  CHECK(run("erp new controller lean " + project).exit_code == 2);
  CHECK(run("erp new controller Not-A-Name " + (folder / "x")).exit_code == 2);
}

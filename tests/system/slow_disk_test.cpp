// Lockstep runs faster than real time and does not wait for the logger. Messages are buffered while
// the disk stalls and while the logger is not scheduled, as on a busy machine.
#include <catch2/catch.hpp>

#include "tests/system/background.hpp"

using namespace tests;

TEST_CASE("a disk stall of 1 s loses no message of a lockstep recording") {
  const Folder folder;
  const auto graph = run("ERP_STALL_MS=1000 LD_PRELOAD=" ERP_SLOW_DISK
                         " erp launch launch/hinge_rig.xml --lockstep --for 20s --out " +
                         folder / "run");
  INFO(graph.output);
  REQUIRE(graph.exit_code == 0);
  REQUIRE(content(folder / "run/logger.log").find("the disk stalls for 1000 ms") !=
          std::string::npos);
  CHECK(graph.output.find("messages are missing") == std::string::npos);
  const auto rows = run("erp log export " + folder / "run/hinge_rig.mcap" + " | grep -c '^[0-9]'");
  CHECK(rows.output == "10000\n");
}

TEST_CASE("a logger that does not run for 0.3 s loses no message of a lockstep recording") {
  const Folder folder;
  Background graph(
      {"launch", "launch/hinge_rig.xml", "--lockstep", "--for", "20s", "--out", folder / "run"},
      folder / "run.txt");
  REQUIRE(graph.wait_for_output("logger: active"));
  const pid_t logger = graph.child("logger");
  REQUIRE(logger > 0);
  kill(logger, SIGSTOP);
  std::this_thread::sleep_for(300ms);
  kill(logger, SIGCONT);
  CHECK(graph.wait() == 0);
  INFO(graph.output());
  CHECK(graph.output().find("messages are missing") == std::string::npos);
  const auto rows = run("erp log export " + folder / "run/hinge_rig.mcap" + " | grep -c '^[0-9]'");
  CHECK(rows.output == "10000\n");
}

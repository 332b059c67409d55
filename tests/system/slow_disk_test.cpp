// Lockstep runs faster than real time and does not wait for the logger. Messages are buffered while
// the disk stalls and while the logger is not scheduled, as on a busy machine.
#include <catch2/catch.hpp>

#include <regex>

#include "tests/system/background.hpp"
#include "tests/system/recorded.hpp"

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

TEST_CASE(
    "while the disk is full the robot runs on; then the recording resumes, and the loss is told") {
  const Folder folder;
  const std::string full = folder / "full";
  setenv("ERP_FULL_FILE", full.c_str(), 1);
  setenv("LD_PRELOAD", ERP_SLOW_DISK, 1);
  Background graph({"launch", "launch/hinge_rig.xml", "--out", folder / "run"}, folder / "run.txt");
  unsetenv("LD_PRELOAD"), unsetenv("ERP_FULL_FILE");
  REQUIRE(graph.wait_for_output("all components are active"));
  std::this_thread::sleep_for(2s);
  std::ofstream(full).flush();
  REQUIRE(
      graph.wait_for_output("No space left on device; free some space or record elsewhere; "
                            "messages are lost until a write succeeds"));
  std::this_thread::sleep_for(4s);
  std::filesystem::remove(full);
  REQUIRE(graph.wait_for_output("the recording resumes; "));
  std::this_thread::sleep_for(2s);
  CHECK(graph.stop() == 0);
  const auto file = folder / "run/hinge_rig.mcap";
  const auto info = run("erp log info " + file);
  INFO(info.output);
  CHECK(info.exit_code == 0);
  CHECK(std::regex_search(
      info.output, std::regex("[0-9]+ messages within [4-7]\\.[0-9] s could not be written")));
  CHECK(info.output.find("complete") != info.output.npos);
  // The robot was controlled all the time: the frames after the gap are numbered as if there was none.
  const Recorded frames(file, "sensor_frame");
  double longest_s = 0, period_s = 0;
  for (std::size_t k = 1; k < frames.messages().size(); ++k) {
    const auto &last = frames.messages()[k - 1], &now = frames.messages()[k];
    const double gap_s = 1e-9 * (number(now, "stamp_ns") - number(last, "stamp_ns"));
    if (gap_s <= longest_s) continue;
    longest_s = gap_s;
    period_s = gap_s / (number(now, "sequence") - number(last, "sequence"));
  }
  CHECK(longest_s > 3);
  CHECK(period_s == Approx(0.002).epsilon(0.02));
}

TEST_CASE("a recording that cannot be begun leaves no file") {
  const Folder folder;
  const std::string full = folder / "full";
  std::ofstream(full).flush();
  const auto graph = run(
      "ERP_FULL_FILE=" + full +
      " LD_PRELOAD=" ERP_SLOW_DISK " erp launch launch/idle.xml --for 2s --out " + folder / "run");
  INFO(graph.output);
  CHECK(graph.exit_code != 0);
  CHECK_FALSE(std::filesystem::exists(folder / "run/idle.mcap"));
}

// A component is killed during a run: its actuators enter the safe state in time, the graph
// resumes, and no process remains.
#include <catch2/catch.hpp>
#include <cmath>
#include <iostream>
#include <optional>

#include "firmware/core/ecu.h"
#include "tests/stalls.hpp"
#include "tests/system/background.hpp"
#include "tests/system/recorded.hpp"

using namespace tests;

namespace {

constexpr double ms = 1e6;            // in ns
constexpr double scheduling_ms = 10;  // scheduling delay of a busy machine

struct Killed {
  std::int64_t at_ns = 0;
  std::string output;
  int exit_code = -1;
};

/// Launches the rig, kills one component, waits until the graph resumes, and stops it.
Killed run_and_kill(const std::string& program, const std::string& folder,
                    const std::vector<std::string>& options = {}) {
  std::vector<std::string> arguments{"launch", "launch/hinge_rig.xml", "--out", folder};
  arguments.insert(arguments.end(), options.begin(), options.end());
  Background graph(arguments, folder + ".txt");
  REQUIRE(graph.wait_for_output("all components are active"));
  std::this_thread::sleep_for(1s);
  const pid_t first_pid = graph.child(program);
  REQUIRE(first_pid > 0);
  Killed killed;
  killed.at_ns = wall_ns();
  kill(first_pid, SIGKILL);
  REQUIRE(wait_until([&] {
    const auto now = graph.child(program);
    return now > 0 && now != first_pid;
  }));
  std::this_thread::sleep_for(2s);
  const auto children = graph.children();
  killed.exit_code = graph.stop();
  killed.output = content(folder + ".txt");
  for (const auto child : children) CHECK(kill(child, 0) != 0);
  return killed;
}

/// Time in ms from `from_ns` to the first later ecu_frame in which `is_safe` holds for every
/// channel.
template <class IsSafe>
std::optional<double> safe_after_ms(const Recorded& frames, std::int64_t from_ns, IsSafe is_safe) {
  for (const auto& frame : frames.messages()) {
    const double stamp_ns = number(frame, "stamp_ns");
    if (stamp_ns < static_cast<double>(from_ns)) continue;
    bool all_safe = true;
    for (const auto& channel : elements(frame, "channels"))
      all_safe = all_safe && is_safe(*channel.members());
    if (all_safe) return (stamp_ns - static_cast<double>(from_ns)) / ms;
  }
  return std::nullopt;
}

bool is_running(const recording::Members& channel) {
  return number(channel, "state") == int{ECU_STATE_RUNNING};
}

/// Checks that in the last frame every channel runs and force_control owns every actuator.
void check_resumed(const std::string& file) {
  const Recorded frames(file, "ecu_frame"), owners(file, "actuator_owner");
  for (const auto& channel : elements(frames.messages().back(), "channels"))
    CHECK(is_running(*channel.members()));
  for (const auto& owner : elements(owners.messages().back(), "actuators"))
    CHECK(text(*owner.members(), "owner") == "force_control");
}

/// Prints a reaction time. Returns a finding if it exceeds the limit plus the scheduling delay.
Findings check_time(const std::string& reaction, std::optional<double> after_ms, double limit_ms) {
  const std::string message =
      reaction + (after_ms ? " after " + std::to_string(*after_ms) + " ms" : ": never");
  std::cout << message << std::endl;
  if (after_ms && *after_ms < limit_ms + scheduling_ms) return {};
  return {message + ", limit " + std::to_string(limit_ms)};
}

std::string file_in(const Folder& folder) { return folder / "run/hinge_rig.mcap"; }

/// Kills a program of the rig and checks that every channel is safe in time and the graph resumes.
template <class IsSafe>
void check_safe_in_time(const std::string& program, const std::string& reaction, double limit_ms,
                        IsSafe is_safe) {
  bool had_reaction =
      false;  // in any attempt, also one that was repeated because of machine stalls
  in_real_time([&] {
    const Folder folder;
    const auto killed = run_and_kill(program, folder / "run");
    CHECK(killed.exit_code == 0);
    const Recorded frames(file_in(folder), "ecu_frame");
    check_resumed(file_in(folder));
    const auto after_ms = safe_after_ms(frames, killed.at_ns, is_safe);
    had_reaction = had_reaction || after_ms;
    return check_time(reaction, after_ms, limit_ms);
  });
  CHECK(had_reaction);
}

}  // namespace

TEST_CASE("after a controller is killed, its actuators execute their safe action within 22 ms") {
  // The safe action of hinge_rig is force mode at relax_tension_N, 2 N. The controller commands 5 N
  // and more.
  check_safe_in_time(
      "force_control", "controller killed: safe action", 22, [](const recording::Members& c) {
        return number(c, "request") == int{ECU_REQUEST_FORCE} && number(c, "setpoint") == 2000;
      });
}

TEST_CASE("after the plant is killed, every ECU is at PWM 0 within 52 ms") {
  check_safe_in_time("plant", "plant killed: PWM 0", 52, [](const recording::Members& c) {
    return number(c, "state") == int{ECU_STATE_FAULT} && number(c, "duty_counts") == 0;
  });
}

TEST_CASE("a killed simulator is reported within 52 ms and restarts with disarmed channels") {
  bool had_reaction =
      false;  // in any attempt, also one that was repeated because of machine stalls
  in_real_time([&] {
    const Folder folder;
    const auto killed = run_and_kill("sim", folder / "run");
    CHECK(killed.exit_code == 0);
    const Recorded events(file_in(folder), "event"), frames(file_in(folder), "ecu_frame");
    std::optional<double> lost_ms;
    for (const auto& event : events.messages())
      if (text(event, "code") == "device_lost" && !lost_ms)
        lost_ms = (number(event, "stamp_ns") - static_cast<double>(killed.at_ns)) / ms;
    const auto disarmed_ms = safe_after_ms(
        frames, killed.at_ns + static_cast<std::int64_t>(20 * ms), [](const recording::Members& c) {
          return number(c, "duty_counts") == 0 && !is_running(c);
        });
    CHECK(disarmed_ms);
    check_resumed(file_in(folder));
    had_reaction = had_reaction || lost_ms;
    return check_time("simulator killed: detected", lost_ms, 52);
  });
  CHECK(had_reaction);
}

TEST_CASE("after the gateway is killed, ECUs enter the fault state and the graph resumes") {
  Folder folder;
  const std::string bus = "udp:239.255.42.7:" + std::to_string(21000 + own_domain);
  const auto killed =
      run_and_kill("gateway", folder / "run",
                   {"--device", "can", "--set", "gateway.bus=" + bus, "--set", "sim.bus=" + bus});
  CHECK(killed.exit_code == 0);
  const Recorded events(file_in(folder), "event");
  bool tripped = false;
  for (const auto& event : events.messages())
    tripped = tripped || text(event, "code") == "ecu_fault";
  CHECK(tripped);
  check_resumed(file_in(folder));
}

TEST_CASE("a killed logger loses at most 1 s of data, and erp log recover repairs its file") {
  Folder folder;
  const auto killed = run_and_kill("logger", folder / "run");
  CHECK(killed.exit_code == 0);
  const auto earlier_part = folder / "run/hinge_rig.1.mcap", repaired = folder / "repaired.mcap";
  CHECK_FALSE(recording::McapReader(earlier_part).complete());
  CHECK(run("erp log recover " + earlier_part + " --out " + repaired).exit_code == 0);
  CHECK(recording::McapReader(repaired).complete());
  const Recorded before(repaired, "ecu_frame"), after(file_in(folder), "ecu_frame");
  const double lost_ms =
      (static_cast<double>(killed.at_ns) - number(before.messages().back(), "stamp_ns")) / ms;
  std::cout << "logger killed: the last " << lost_ms << " ms are lost\n";
  CHECK(lost_ms < 1000 + scheduling_ms);
  CHECK(after.messages().size() > 500);
  INFO(killed.output);
  CHECK(killed.output.find("logger restarted 1 time,") != std::string::npos);
  CHECK(killed.output.find("recording in 2 parts") != std::string::npos);
  CHECK(killed.output.find(earlier_part) != std::string::npos);
}

TEST_CASE("after the launcher is killed, no process remains and the recording is complete") {
  Folder folder;
  std::vector<pid_t> children;
  {
    Background graph({"launch", "launch/hinge_rig.xml", "--out", folder / "run"},
                     folder / "run.txt");
    REQUIRE(graph.wait_for_output("all components are active"));
    children = graph.children();
    CHECK(graph.stop(SIGKILL) == 128 + SIGKILL);
  }
  REQUIRE(children.size() == 5);
  for (const auto child : children) CHECK(wait_until([&] { return kill(child, 0) != 0; }));
  CHECK(recording::McapReader(file_in(folder)).complete());
}

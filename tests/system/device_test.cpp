// Conformance tests for all devices (sim, can, replay); closed-loop tests on sim and can;
// repeatability of runs.
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <regex>
#include <set>

#include "firmware/core/ecu.h"
#include "tests/stalls.hpp"
#include "tests/system/background.hpp"
#include "tests/system/recorded.hpp"

using namespace tests;

namespace {

std::string bus() { return "udp:239.255.42.8:" + std::to_string(22000 + own_domain); }

/// Command-line options that select a device.
std::string device_options(const std::string& device, const std::string& recording) {
  if (device == "can") return "--device can --set gateway.bus=" + bus() + " --set sim.bus=" + bus();
  return device == "replay" ? "--device replay:" + recording : "--device sim";
}

/// Runs a graph for some simulated seconds and returns the recording.
std::string record(const Folder& folder, const std::string& name, const std::string& graph,
                   const std::string& options) {
  const auto out = folder / name;
  const auto file = out + ".mcap";
  const auto outcome =
      run("erp launch " + graph + " " + options + " --out " + out + " --set logger.file=" + file);
  INFO(outcome.output);
  REQUIRE(outcome.exit_code == 0);
  return file;
}

std::string export_of(const std::string& file) {
  const auto outcome = run("erp log export " + file);
  REQUIRE(outcome.exit_code == 0);
  return outcome.output;
}

/// Removes repeated frames. In lockstep a device repeats a frame if no command arrives within 0.2
/// s, which happens on a busy machine.
std::vector<recording::Members> without_repeats(const std::vector<recording::Members>& frames) {
  std::vector<recording::Members> unrepeated;
  for (const auto& frame : frames)
    if (unrepeated.empty() || number(unrepeated.back(), "sequence") != number(frame, "sequence"))
      unrepeated.push_back(frame);
  return unrepeated;
}

}  // namespace

TEST_CASE(
    "frames of every device contain all channels, with consecutive numbers, at the ECU period") {
  Folder folder;
  const auto original = record(folder, "original", "launch/force_step.xml", "--lockstep --for 1s");
  for (const std::string device : {"sim", "can", "replay"}) {
    INFO(device);
    const auto file = record(folder, device, "launch/force_step.xml",
                             "--lockstep --for 1s " + device_options(device, original));
    const Recorded frames(file, "ecu_frame");
    const auto unrepeated = without_repeats(frames.messages());
    REQUIRE(unrepeated.size() == 500);
    for (std::size_t k = 0; k < unrepeated.size(); ++k) {
      CHECK(number(unrepeated[k], "stamp_ns") == Approx(2e6 * static_cast<double>(k)));
      CHECK(number(unrepeated[k], "sequence") ==
            number(unrepeated[0], "sequence") + static_cast<double>(k));
      std::set<std::pair<double, double>> channels;
      for (const auto& value : elements(unrepeated[k], "channels")) {
        const auto& channel = *value.members();
        channels.insert({number(channel, "ecu"), number(channel, "channel")});
        CHECK(std::get<bool>(channel.find("fresh")->data));
        CHECK(std::abs(number(channel, "duty_counts")) <= ECU_DUTY_MAX);
        const auto state = number(channel, "state");
        if (state < int{ECU_STATE_RUNNING}) CHECK(number(channel, "duty_counts") == 0);
      }
      CHECK(channels == std::set<std::pair<double, double>>{{0, 0}, {0, 1}});
    }
  }
}

TEST_CASE("a repeated lockstep run exports the same bytes, on the simulator and over the CAN bus") {
  Folder folder;
  const auto step = [&](const std::string& name, const std::string& device) {
    return export_of(record(folder, name, "launch/force_step.xml",
                            "--lockstep --for 2s " + device_options(device, "")));
  };
  const auto first = step("first", "sim");
  CHECK(first.size() > 100000);
  CHECK(step("second", "sim") == first);
  CHECK(step("bus", "can") == first);
}

TEST_CASE("a replayed recording reproduces its sensor readings") {
  Folder folder;
  const auto original = record(folder, "original", "launch/force_step.xml", "--lockstep --for 2s");
  const auto replayed = record(folder, "again", "launch/force_step.xml",
                               "--lockstep --for 2s " + device_options("replay", original));
  CHECK(export_of(replayed) == export_of(original));
}

TEST_CASE("the intervals of a replayed real-time recording are exact to 1 ns") {
  Folder folder;
  const auto stamps = [](const std::string& file) {
    const Recorded frames(file, "ecu_frame");
    std::vector<std::int64_t> since_first;
    for (const auto& frame : without_repeats(frames.messages()))
      since_first.push_back(std::get<std::int64_t>(frame.find("stamp_ns")->data));
    for (auto k = since_first.rbegin(); k != since_first.rend(); ++k) *k -= since_first.front();
    return since_first;
  };
  const auto original = record(folder, "original", "launch/force_step.xml", "--for 1s");
  const auto again = record(folder, "again", "launch/force_step.xml",
                            "--lockstep --for 2s " + device_options("replay", original));
  CHECK(stamps(original).size() > 100);
  CHECK(stamps(again) == stamps(original));
}

TEST_CASE("the summary of a run grades the errors of joints") {
  const Folder folder;
  const auto ran =
      run("erp launch launch/puller_follower.xml --lockstep --for 3s --out " + folder / "run");
  INFO(ran.output);
  CHECK(ran.exit_code == 0);
  const std::regex row(
      "\njoint +RMS error +largest\nelbow +(good|fair|poor) +[0-9.]+ ° +[0-9.]+ °\n");
  CHECK(std::regex_search(ran.output, row));
}

TEST_CASE("a force step: rise time at most 318 ms, steady-state RMS error at most 0.236 N") {
  const auto outcome =
      run("erp launch launch/force_step.xml --lockstep --for 5s --out $(mktemp -d)/run");
  CHECK(outcome.exit_code == 0);
  INFO(outcome.output);
  const auto line_begin = outcome.output.find("flexor steps");
  REQUIRE(line_begin != std::string::npos);
  double from_N, to_N, start_s, rise_ms, overshoot_N, steady_N;
  REQUIRE(std::sscanf(outcome.output.c_str() + line_begin,
                      "flexor steps %lf N -> %lf N at %lf s: rise (10-90 %%) %lf ms, overshoot %lf "
                      "N, steady RMS %lf N",
                      &from_N, &to_N, &start_s, &rise_ms, &overshoot_N, &steady_N) == 6);
  CHECK(rise_ms <= 318);
  CHECK(steady_N <= 0.236);
}

/// Checks that the arm holds its poses. Returns findings if the recording lacks ticks of a pose.
Findings holds_poses() {
  const Folder folder;
  const auto file = record(folder, "arm", "launch/arm.xml", "--lockstep --for 45s");
  const Recorded joints(file, "joint_state");
  // poses.csv: 1.5 s of motion and 1.5 s of rest per pose. The drift is measured over the last 0.5
  // s of rest.
  std::map<int, const recording::Members*> at_tick;
  for (const auto& state : joints.messages())
    if (text(state, "source") == "sim")
      at_tick[static_cast<int>(number(state, "sequence"))] = &state;
  Findings findings;
  const auto elbow_rad = [&](double time_s) {
    const auto tick = static_cast<int>(std::lround(time_s * 500));
    const auto next = at_tick.upper_bound(tick);  // a busy machine may lose a tick
    REQUIRE(next != at_tick.begin());
    if (const int lost = tick - std::prev(next)->first; lost >= 5)
      findings.push_back(std::to_string(lost) + " ticks are lost at " + std::to_string(time_s) +
                         " s");
    const auto& joint_values = elements(*std::prev(next)->second, "joints");
    for (const auto& joint : joint_values)
      if (text(*joint.members(), "name") == "elbow")
        return elements(*joint.members(), "position")[0].number().value();
    FAIL("no elbow");
    return 0.0;
  };
  std::set<int> poses;
  for (int pose = 0; pose < 15; ++pose) {
    const double end_s = 3.0 * (pose + 1) - 0.01;
    const double drift_rad = elbow_rad(end_s) - elbow_rad(end_s - 0.5);
    poses.insert(static_cast<int>(std::lround(elbow_rad(end_s) * 50)));
    if (!findings.empty()) return findings;
    CHECK(std::abs(drift_rad) < 0.2 * 3.14159 / 180);
  }
  CHECK(poses.size() >= 5);
  return findings;
}

TEST_CASE("the arm holds 15 poses under length control without drift") {
  in_real_time(holds_poses);
}

// Run by tests/hal/uml/run_in_uml.sh. The gateway's reaction to bus faults, on a real CAN device
// whose adapter reports them.
#include <catch2/catch.hpp>
#include <chrono>

#include "hal/can/bus_keeper.hpp"
#include "hal/can/robot_buses.hpp"
#include "tests/hal/can/link_both.hpp"
#include "tests/hal/can/slcan_adapter.hpp"
#include "tests/stalls.hpp"

using namespace can_test;
using erp::BusState;

namespace {

constexpr std::int64_t ms = 1'000'000;

std::int64_t now_ns() {
  return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

/// The adapter, and the gateway's BusKeeper of its bus.
struct Line {
  SlcanAdapter adapter;
  erp::BusKeeper keeper{"left", erp::open_bus(adapter.where(), {.window = 2})};
  std::vector<std::pair<std::string, std::int64_t>> notices;  ///< code and time

  /// Acts as the gateway process for a time: reads, supervises, and sends a command every 2 ms if
  /// requested.
  void pass(std::int64_t for_ns, bool commanding = false) {
    std::int64_t next_command = now_ns();
    for (const auto end = now_ns() + for_ns; now_ns() < end;) {
      std::array<erp::CanFrame, 16> frames;
      keeper.bus().receive(frames, 0.001);
      if (commanding && now_ns() >= next_command) command(), next_command += 2 * ms;
      for (const auto& notice : keeper.supervise(now_ns()))
        notices.emplace_back(notice.code, now_ns());
    }
  }
  void command() {
    const frame_command content_of_command{{{3, ++setpoint}, {FRAME_REQUEST_NONE, 0}}, 0, 0};
    erp::CanFrame frame;
    frame_pack_command(&frame, 3, &content_of_command);
    keeper.post({&frame, 1}, now_ns());
  }
  bool was_reported(const std::string& code) const { return time_of(code) != 0; }
  std::int64_t time_of(const std::string& code) const {
    for (const auto& [notice, time_ns] : notices)
      if (notice == code) return time_ns;
    return 0;
  }
  int count_of(const std::string& code) const {
    return int(std::count_if(notices.begin(), notices.end(),
                             [&](const auto& notice) { return notice.first == code; }));
  }
  /// The set-points that the adapter has received after the first `from` frames.
  std::vector<int> setpoints(std::size_t from) {
    std::vector<int> setpoints;
    const auto sent = adapter.sent();
    for (std::size_t i = from; i < sent.size(); ++i) {
      erp::CanFrame frame{0, 8, {}};
      frame.id = std::uint16_t(std::stoi(sent[i].substr(1, 3), nullptr, 16));
      for (std::size_t k = 0; k < 8; ++k)
        frame.data[k] = std::uint8_t(std::stoi(sent[i].substr(5 + 2 * k, 2), nullptr, 16));
      frame_command command;
      REQUIRE(frame_unpack_command(&frame, &command));
      setpoints.push_back(command.channel[0].setpoint);
    }
    return setpoints;
  }
  int setpoint = 0;
};

}  // namespace

TEST_CASE("frames go through the adapter both ways") {
  Line line;
  line.command();
  line.pass(20 * ms);
  CHECK(line.setpoints(0) == std::vector<int>{1});
  line.adapter.send("t1808DEADBEEF01020304");
  line.pass(20 * ms);
  CHECK(line.keeper.counters().received == 1);
}

TEST_CASE("error-warning, error-passive and error-active are reported, in this order") {
  Line line;
  for (const char* counters : {"sw100020", "sp020130", "sa010010"}) {
    line.adapter.send(counters);
    line.pass(20 * ms);
  }
  REQUIRE(line.notices.size() == 3);
  CHECK(line.notices[0].first == "bus_warning");
  CHECK(line.notices[1].first == "bus_passive");
  CHECK(line.notices[2].first == "bus_active");
}

/// Delay that a busy machine may add, as in tests/faults; the measured time is printed.
constexpr std::int64_t scheduling_ns = 10 * ms;

/// Adds a finding if a time is not within min_ns … max_ns, extended by the scheduling delay.
void check_time(tests::Findings& findings, const char* action, std::int64_t duration_ns,
                std::int64_t min_ns, std::int64_t max_ns) {
  const std::string text =
      action + (" after " + std::to_string(1e-6 * double(duration_ns)) + " ms");
  std::printf("%s\n", text.c_str());
  if (duration_ns < min_ns - scheduling_ns || duration_ns >= max_ns + scheduling_ns)
    findings.push_back(text);
}

TEST_CASE("bus-off is detected within 5 ms; after a restart the bus works again") {
  tests::in_real_time([] {
    Line line;
    line.pass(20 * ms, true);
    const auto before = now_ns();
    line.adapter.send("sb256256");
    line.pass(60 * ms, true);
    REQUIRE(line.was_reported("bus_off"));
    tests::Findings findings;
    check_time(findings, "bus-off detected", line.time_of("bus_off") - before, 0, 5 * ms);
    if (!line.was_reported("bus_restarted")) findings.push_back("not restarted in 60 ms");
    if (!findings.empty()) return findings;
    CHECK(line.adapter.opened() == 2);
    const auto sent = line.adapter.sent().size();
    const int newest = line.setpoint;
    line.pass(20 * ms, true);
    const auto after = line.setpoints(sent);
    if (after.size() <= 3) findings.push_back(std::to_string(after.size()) + " commands in 20 ms");
    else CHECK(after[0] > newest - 2);
    return findings;
  });
}

TEST_CASE("a bus with repeated bus-off is restarted three times, then stays off") {
  tests::in_real_time([] {
    Line line;
    for (int k = 0; k < 60; ++k) {
      line.adapter.send("sb256256");
      line.pass(20 * ms, true);
    }
    CHECK(line.count_of("bus_restarted") == 3);
    CHECK(line.count_of("bus_off_latched") == 1);
    CHECK(line.keeper.given_up());
    tests::Findings findings;
    std::int64_t last = 0;
    for (const auto& [code, time_ns] : line.notices) {
      if (code != "bus_restarted") continue;
      if (last) check_time(findings, "bus restarted again", time_ns - last, 100 * ms, INT64_MAX / 2);
      last = time_ns;
    }
    const auto sent = line.adapter.sent().size();
    line.pass(50 * ms, true);
    CHECK(line.adapter.sent().size() == sent);
    return findings;
  });
}

TEST_CASE("an open cable is detected within 25 ms, and no burst follows when it is closed") {
  tests::in_real_time([] {
    Line line;
    line.pass(20 * ms, true);
    line.adapter.send("t1808DEADBEEF01020304");
    line.pass(10 * ms, true);
    const auto opened = now_ns();
    for (int k = 0; k < 30; ++k) {
      line.adapter.send("e1a");
      line.pass(2 * ms, true);
    }
    REQUIRE(line.was_reported("not_acknowledged"));
    const auto detected_after_ns = line.time_of("not_acknowledged") - opened;
    CHECK(detected_after_ns >= 20 * ms);
    tests::Findings findings;
    check_time(findings, "open cable detected", detected_after_ns, 0, 25 * ms);
    const auto sent = line.adapter.sent().size();
    line.pass(100 * ms, true);
    CHECK(line.adapter.sent().size() == sent);
    const int newest = line.setpoint;
    line.adapter.send("t1808DEADBEEF01020304");
    line.pass(20 * ms, true);
    const auto after = line.setpoints(sent);
    if (!line.was_reported("acknowledged") || after.empty())
      findings.push_back("closed: silent for 20 ms");
    else CHECK(after[0] > newest - 2);
    return findings;
  });
}

constexpr int line_capacity_frames = 170;  // 4 kB of 22 bytes each

TEST_CASE("after an adapter's stall its own queue is sent, then only new set-points") {
  Line line;
  line.pass(20 * ms, true);
  line.adapter.stall(true);
  line.pass(20 * ms, true);
  const int stalled_at = line.setpoint;
  line.pass(2000 * ms, true);
  const auto sent = line.adapter.sent().size();
  const int newest = line.setpoint;
  line.adapter.stall(false);
  line.pass(100 * ms, true);
  int stale = 0;
  for (const int setpoint : line.setpoints(sent)) stale += setpoint <= newest - 2;
  const auto& outbox = line.keeper.outbox();
  const int lost = int(outbox.expired() + outbox.replaced());
  WARN(newest - stalled_at << " set-points while it was stalled; " << lost << " never left, "
                           << stale << " old ones came out");
  CHECK(stale < line_capacity_frames);
  CHECK(lost > newest - stalled_at - line_capacity_frames);
  CHECK(line.setpoints(sent).back() >= line.setpoint - 3);
}

TEST_CASE("an interface with another bit rate than planned is refused") {
  SlcanAdapter adapter;
  erp::Robot robot = robot_of(2);
  robot.can_buses = robot.buses();
  CHECK_NOTHROW(erp::open_buses(robot, adapter.where()));
  robot.can_buses[0].bitrate_per_s = 500'000;
  CHECK_THROWS_WITH(erp::open_buses(robot, adapter.where()),
                    Catch::Contains("runs at 1000000 bit/s, robot.xml plans 500000 for bus"));
}

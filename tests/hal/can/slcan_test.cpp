// Run by tests/hal/uml/run_in_uml.sh. The gateway's reaction to bus faults, on a real CAN device whose
// adapter reports them.
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
  std::vector<std::pair<std::string, std::int64_t>> content;  ///< code and time

  /// Does what the gateway process does, for a time: reads, supervises, and commands every 2 ms if requested.
  void pass(std::int64_t for_ns, bool commanding = false) {
    std::int64_t next_command = now_ns();
    for (const auto end = now_ns() + for_ns; now_ns() < end;) {
      std::array<erp::CanFrame, 16> frames;
      keeper.bus().receive(frames, 0.001);
      if (commanding && now_ns() >= next_command) command(), next_command += 2 * ms;
      for (const auto& notice : keeper.supervise(now_ns()))
        content.emplace_back(notice.code, now_ns());
    }
  }
  void command() {
    const frame_command said_now{{{3, ++setpoint}, {FRAME_REQUEST_NONE, 0}}, 0, 0};
    erp::CanFrame frame;
    frame_pack_command(&frame, 3, &said_now);
    keeper.post({&frame, 1}, now_ns());
  }
  bool has_said(const std::string& code) const { return when(code) != 0; }
  std::int64_t when(const std::string& code) const {
    for (const auto& [what, at] : content)
      if (what == code) return at;
    return 0;
  }
  int times(const std::string& code) const {
    return int(std::count_if(content.begin(), content.end(),
                             [&](const auto& one) { return one.first == code; }));
  }
  /// The set-points that the adapter has received after the first `from` frames.
  std::vector<int> setpoints(std::size_t from) {
    std::vector<int> found;
    const auto sent = adapter.sent();
    for (std::size_t i = from; i < sent.size(); ++i) {
      erp::CanFrame frame{0, 8, {}};
      frame.id = std::uint16_t(std::stoi(sent[i].substr(1, 3), nullptr, 16));
      for (std::size_t k = 0; k < 8; ++k)
        frame.data[k] = std::uint8_t(std::stoi(sent[i].substr(5 + 2 * k, 2), nullptr, 16));
      frame_command command;
      REQUIRE(frame_unpack_command(&frame, &command));
      found.push_back(command.channel[0].setpoint);
    }
    return found;
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
  REQUIRE(line.content.size() == 3);
  CHECK(line.content[0].first == "bus_warning");
  CHECK(line.content[1].first == "bus_passive");
  CHECK(line.content[2].first == "bus_active");
}

/// Delay that a busy machine may add, as in tests/faults/row.hpp; the measured time is printed.
constexpr std::int64_t scheduling = 10 * ms;

/// Fails if a time is not in this range, plus the scheduling delay.
void in_time(tests::Complaints& wrong, const char* what, std::int64_t took, std::int64_t least,
             std::int64_t most) {
  const std::string content = what + (" after " + std::to_string(1e-6 * double(took)) + " ms");
  std::printf("%s\n", content.c_str());
  if (took < least - scheduling || took >= most + scheduling) wrong.push_back(content);
}

TEST_CASE("bus-off is detected within 5 ms; after a restart the bus works again") {
  tests::in_real_time([] {
    Line line;
    line.pass(20 * ms, true);
    const auto before = now_ns();
    line.adapter.send("sb256256");
    line.pass(60 * ms, true);
    REQUIRE(line.has_said("bus_off"));
    tests::Complaints wrong;
    in_time(wrong, "bus-off detected", line.when("bus_off") - before, 0, 5 * ms);
    if (!line.has_said("bus_restarted")) wrong.push_back("not restarted in 60 ms");
    if (!wrong.empty()) return wrong;
    CHECK(line.adapter.opened() == 2);
    const auto sent = line.adapter.sent().size();
    const int newest = line.setpoint;
    line.pass(20 * ms, true);
    const auto after = line.setpoints(sent);
    if (after.size() <= 3) wrong.push_back(std::to_string(after.size()) + " commands in 20 ms");
    else CHECK(after[0] > newest - 2);
    return wrong;
  });
}

TEST_CASE("a bus with repeated bus-off is restarted three times, then stays off") {
  tests::in_real_time([] {
    Line line;
    for (int k = 0; k < 60; ++k) {
      line.adapter.send("sb256256");
      line.pass(20 * ms, true);
    }
    CHECK(line.times("bus_restarted") == 3);
    CHECK(line.times("bus_off_latched") == 1);
    CHECK(line.keeper.given_up());
    tests::Complaints wrong;
    std::int64_t last = 0;
    for (const auto& [code, when] : line.content) {
      if (code != "bus_restarted") continue;
      if (last) in_time(wrong, "bus restarted again", when - last, 100 * ms, INT64_MAX / 2);
      last = when;
    }
    const auto sent = line.adapter.sent().size();
    line.pass(50 * ms, true);
    CHECK(line.adapter.sent().size() == sent);
    return wrong;
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
    REQUIRE(line.has_said("not_acknowledged"));
    const auto noticed = line.when("not_acknowledged") - opened;
    CHECK(noticed >= 20 * ms);
    tests::Complaints wrong;
    in_time(wrong, "open cable detected", noticed, 0, 25 * ms);
    const auto sent = line.adapter.sent().size();
    line.pass(100 * ms, true);
    CHECK(line.adapter.sent().size() == sent);
    const int newest = line.setpoint;
    line.adapter.send("t1808DEADBEEF01020304");
    line.pass(20 * ms, true);
    const auto after = line.setpoints(sent);
    if (!line.has_said("acknowledged") || after.empty())
      wrong.push_back("closed: silent for 20 ms");
    else CHECK(after[0] > newest - 2);
    return wrong;
  });
}

constexpr int fits_into_the_line = 170;  // 4 kB of 22 bytes each

TEST_CASE("after a stalled adapter's own queue only new set-points are sent") {
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
  const int gone = int(outbox.expired() + outbox.replaced());
  WARN(newest - stalled_at << " set-points while it was stalled; " << gone << " never left, "
                           << stale << " old ones came out");
  CHECK(stale < fits_into_the_line);
  CHECK(gone > newest - stalled_at - fits_into_the_line);
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

// Supervision of a bus by the gateway: pure, on a simulated bus. slcan_test does the same with the
// error frames of a real controller.
#include "hal/can/bus_keeper.hpp"

#include <catch2/catch.hpp>

#include "hal/can/ecu_watch.hpp"
#include "tests/hal/can/narrow_bus.hpp"

using namespace can_test;
using erp::BusRecovery;
using erp::BusState;

namespace {

constexpr std::int64_t ms_in_ns = 1'000'000;

struct SupervisedBus {
  NarrowBus* bus = new NarrowBus;
  erp::BusKeeper keeper{"left", std::unique_ptr<erp::CanBus>(bus)};
  std::int64_t now_ns = ms_in_ns;

  /// Supervises the bus every millisecond; returns the codes of the notices.
  std::vector<std::string> pass(int milliseconds) {
    std::vector<std::string> codes;
    for (int k = 0; k < milliseconds; ++k, now_ns += ms_in_ns)
      for (const auto& notice : keeper.supervise(now_ns)) codes.push_back(notice.code);
    return codes;
  }
  void command() {
    const frame_command content{{{3, 7}, {FRAME_REQUEST_NONE, 0}}, 0, 0};
    erp::CanFrame frame;
    frame_pack_command(&frame, 3, &content);
    keeper.post({&frame, 1}, now_ns);
  }
};
using Codes = std::vector<std::string>;

}  // namespace

TEST_CASE("a bus in bus-off is restarted three times at intervals of 100 ms, then no more") {
  BusRecovery recovery;
  std::vector<std::int64_t> restart_times_ms;
  bool has_given_up = false;
  for (std::int64_t now = 0; now < 2000 * ms_in_ns; now += ms_in_ns)
    switch (recovery.step(true, now)) {
      case BusRecovery::Action::restart:
        REQUIRE_FALSE(has_given_up);
        restart_times_ms.push_back(now / ms_in_ns);
        break;
      case BusRecovery::Action::give_up:
        REQUIRE_FALSE(has_given_up);
        has_given_up = true;
        break;
      case BusRecovery::Action::nothing:
        break;
    }
  CHECK(restart_times_ms == std::vector<std::int64_t>{0, 100, 200});
  CHECK(has_given_up);
}

TEST_CASE("after ten seconds without bus-off the restarts are available again") {
  BusRecovery recovery;
  const auto restarts_again = [&](std::int64_t now) {
    return recovery.step(true, now) == BusRecovery::Action::restart;
  };
  for (int k = 0; k < 3; ++k) CHECK(restarts_again(k * 100 * ms_in_ns));
  CHECK(recovery.step(false, 9000 * ms_in_ns) == BusRecovery::Action::nothing);
  CHECK(recovery.restarts() == 3);
  recovery.step(false, 10'201 * ms_in_ns);
  CHECK(recovery.restarts() == 0);
  CHECK(restarts_again(10'300 * ms_in_ns));
}

TEST_CASE("bus-off is reported, the queue is dropped, and nothing is sent until it ends") {
  SupervisedBus supervised;
  supervised.pass(1);
  supervised.bus->bus_counters.state = BusState::off;
  supervised.command();
  supervised.bus->room = 10;
  CHECK(supervised.pass(1) == Codes{"bus_off", "bus_restarted"});
  supervised.command();
  CHECK(supervised.pass(250) == Codes{"bus_restarted", "bus_restarted"});
  CHECK(supervised.bus->sent_frames.empty());
  CHECK(supervised.keeper.outbox().expired() == 2);
  CHECK(supervised.pass(200) == Codes{"bus_off_latched"});
  CHECK(supervised.pass(1000).empty());
  CHECK(supervised.bus->restarts == 3);
  CHECK(supervised.keeper.given_up());
}

TEST_CASE("error-warning, error-passive and error-active are reported once each") {
  SupervisedBus supervised;
  for (const auto& [state, code] : {std::pair{BusState::warning, "bus_warning"},
                                    {BusState::passive, "bus_passive"},
                                    {BusState::active, "bus_active"},
                                    {BusState::down, "bus_down"}}) {
    supervised.bus->bus_counters.state = state;
    CHECK(supervised.pass(50) == Codes{code});
  }
}

TEST_CASE("frames that are not sent are reported after 20 ms, and no burst follows") {
  SupervisedBus supervised;
  supervised.bus->room = 2;
  supervised.bus->in_flight_frames = 0;
  supervised.command();
  supervised.pass(1);
  supervised.bus->in_flight_frames = 1;  // accepted, not seen on the wire
  CHECK(supervised.pass(19).empty());
  CHECK(supervised.pass(2) == Codes{"not_acknowledged"});
  for (int k = 0; k < 50; ++k) supervised.command(), supervised.pass(2);
  CHECK(supervised.bus->sent_frames.size() == 1);
  supervised.bus->in_flight_frames = 0;  // acknowledged
  supervised.bus->room = 100;
  CHECK(supervised.pass(2) == Codes{"acknowledged"});
  CHECK(supervised.bus->sent_frames.size() == 1);
  supervised.command();
  CHECK(supervised.bus->sent_frames.size() == 2);
}

TEST_CASE("missing acknowledgement is reported only while no frame is received") {
  SupervisedBus supervised;
  supervised.pass(5);
  supervised.bus->bus_counters.unacknowledged = 1;
  CHECK(supervised.pass(10).empty());
  supervised.bus->bus_counters.received = 1;  // another node is present
  CHECK(supervised.pass(100).empty());
  supervised.bus->bus_counters.unacknowledged = 2;
  CHECK(supervised.pass(30) == Codes{"not_acknowledged"});
  supervised.bus->bus_counters.received = 2;
  CHECK(supervised.pass(30) == Codes{"acknowledged"});
}

TEST_CASE("a silent ECU is reported after 10 ms, after 50 ms and when it sends again") {
  erp::EcuWatch watch;
  std::vector<std::pair<std::int64_t, erp::EcuWatch::Event>> events;
  const auto pass_until = [&](std::int64_t from_ms, std::int64_t to_ms) {
    for (std::int64_t t = from_ms; t <= to_ms; ++t)
      watch.step(t * ms_in_ns, [&](int ecu, erp::EcuWatch::Event event) {
        CHECK(ecu == 5);
        events.emplace_back(t, event);
      });
  };
  pass_until(0, 100);
  CHECK(events.empty());  // never received
  watch.received(5, 100 * ms_in_ns);
  pass_until(100, 200);
  using enum erp::EcuWatch::Event;
  CHECK(events == decltype(events){{110, silent}, {150, lost}});
  watch.received(5, 200 * ms_in_ns);
  pass_until(200, 205);
  CHECK(events.back() == std::pair{std::int64_t{200}, back});
  watch.received(5, 205 * ms_in_ns);
  pass_until(206, 216);
  watch.received(5, 216 * ms_in_ns);
  pass_until(217, 220);
  CHECK(events.size() == 4);  // silent again; its end is not reported
}

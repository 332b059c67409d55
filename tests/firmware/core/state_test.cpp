#include "firmware/core/state.h"

#include <catch2/catch.hpp>
#include <functional>
#include <vector>

#include "tests/firmware/core/channel.hpp"

using namespace firmware;

namespace {
const ecu_state boot = ECU_STATE_BOOT, idle = ECU_STATE_IDLE, armed = ECU_STATE_ARMED,
                running = ECU_STATE_RUNNING, fault = ECU_STATE_FAULT;

const std::int32_t over_current = ECU_FAULT_OVER_CURRENT;  // the fault used by in_state

struct Row {
  const char* event;
  std::function<void(ecu_channel&)> apply;
  ecu_state from_boot, from_idle, from_armed, from_running, from_fault;
};

auto command(ecu_request request, std::int32_t setpoint = 0) {
  return [=](ecu_channel& c) { ecu_command(&c, request, setpoint); };
}
void commit(ecu_channel& c) { load(c, rig_gains()); }
void bad_commit(ecu_channel& c) {
  Gains gains = rig_gains();
  gains[ECU_PARAMETER_RESISTANCE] = 0;
  load(c, gains);
}
void trip(ecu_channel& c) { ecu_trip(&c, ECU_FAULT_OVER_TENSION); }
void silence(ecu_channel& c) {
  for (unsigned i = 0; i <= ECU_TIMEOUT_TICKS; ++i) tick(c);
}
}  // namespace

TEST_CASE("every event leads from every state to the state in the table") {
  // clang-format off
  const std::vector<Row> rows = {
    // event                                                  boot  idle   armed    running  fault
    {"valid gains", commit,                                   idle, idle,  armed,   running, fault},
    {"implausible gains", bad_commit,                         boot, idle,  armed,   running, fault},
    {"off", command(ECU_REQUEST_OFF),                         boot, idle,  idle,    idle,    fault},
    {"clear", command(ECU_REQUEST_CLEAR, over_current),       boot, idle,  armed,   running, idle},
    {"other clear", command(ECU_REQUEST_CLEAR, 1),            boot, idle,  armed,   running, fault},
    {"arm", command(ECU_REQUEST_ARM),                         boot, armed, armed,   armed,   fault},
    {"voltage", command(ECU_REQUEST_VOLTAGE, 500),            boot, idle,  running, running, fault},
    {"length", command(ECU_REQUEST_LENGTH, 100),              boot, idle,  running, running, fault},
    {"current", command(ECU_REQUEST_CURRENT, 100),            boot, idle,  running, running, fault},
    {"force", command(ECU_REQUEST_FORCE, 2000),               boot, idle,  running, running, fault},
    {"bad set-point", command(ECU_REQUEST_VOLTAGE, 13000),    boot, idle,  armed,   running, fault},
    {"unknown request", command(ecu_request(7), 0),           boot, idle,  armed,   running, fault},
    {"trip", trip,                                            boot, fault, fault,   fault,   fault},
    {"50 ms of silence", silence,                             boot, idle,  fault,   fault,   fault},
  };
  // clang-format on
  for (const Row& row : rows) {
    const ecu_state expected[] = {row.from_boot, row.from_idle, row.from_armed, row.from_running,
                                  row.from_fault};
    for (ecu_state from : {boot, idle, armed, running, fault}) {
      INFO(row.event << " in state " << from);
      ecu_channel channel = in_state(from);
      REQUIRE(channel.state == from);
      row.apply(channel);
      CHECK(channel.state == expected[from]);
      const bool live = channel.state == armed || channel.state == running;
      CHECK((channel.request == ECU_REQUEST_OFF) == !live);
      CHECK((channel.fault == ECU_FAULT_NONE) == (channel.state != fault));
      if (channel.state != running) CHECK(tick(channel) == 0);
    }
  }
}

TEST_CASE("only clear leaves the fault state, and only a gain set leaves boot") {
  for (int event = 0; event < ECU_EVENT_COUNT; ++event) {
    const bool clears = event == ECU_EVENT_CLEAR, loads = event == ECU_EVENT_COMMIT;
    CHECK((ecu_next_state(fault, ecu_event(event)) == (clears ? idle : fault)));
    CHECK((ecu_next_state(boot, ecu_event(event)) == (loads ? idle : boot)));
  }
}

TEST_CASE("only an armed channel can start running") {
  for (int from = 0; from < ECU_STATE_COUNT; ++from)
    for (int event = 0; event < ECU_EVENT_COUNT; ++event)
      if (ecu_next_state(ecu_state(from), ecu_event(event)) == running)
        CHECK((from == running || (from == armed && event == ECU_EVENT_SETPOINT)));
}

TEST_CASE("a mode request in idle is counted and has no effect") {
  ecu_channel channel = in_state(idle);
  for (int i = 0; i < 20; ++i) CHECK_FALSE(ecu_command(&channel, ECU_REQUEST_FORCE, 2000));
  CHECK(channel.rejected_setpoints == 20);
  CHECK(channel.state == idle);
}

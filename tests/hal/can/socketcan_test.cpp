// Run by tests/hal/uml/run_in_uml.sh, under a kernel with CAN: vcan0 and vcan1 are up, vcan2 is
// down.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <string>

#include "hal/can/bus.hpp"
#include "hal/can/trace.hpp"
#include "tests/hal/can/link_both.hpp"

using namespace can_test;

namespace {
const std::string vcan0 = "socketcan:vcan0";

/// Sends a frame on vcan0 with another program.
void cansend(const std::string& frame) {
  REQUIRE(std::system(("cansend vcan0 " + frame).c_str()) == 0);
}
}  // namespace

TEST_CASE(
    "two participants of a CAN interface receive each other's frames, in order and complete") {
  receives_in_order(vcan0);
}
TEST_CASE("own frames are not received on a CAN interface") { does_not_receive_own_frames(vcan0); }
TEST_CASE("all participants of a CAN interface receive the same frames") {
  all_participants_receive(vcan0);
}
TEST_CASE("frames beyond the size of the receive buffer remain in the socket") {
  keeps_remaining_frames(vcan0);
}
TEST_CASE("gateway and ECUs run in lockstep over SocketCAN") { runs_in_lockstep(vcan0); }

TEST_CASE("two interfaces are two buses") {
  const auto a = erp::open_bus(vcan0), b = erp::open_bus("socketcan:vcan1"),
             c = erp::open_bus(vcan0);
  const auto frame = numbered(5);
  a->send({&frame, 1});
  CHECK(same(collect(*c, 1)[0], frame));
  erp::CanFrame extra;
  CHECK(b->receive({&extra, 1}, 0) == 0);
}

TEST_CASE("a frame of another program is received unchanged") {
  const auto bus = erp::open_bus(vcan0);
  cansend("17F#DEADBEEF");
  const auto frame = collect(*bus, 1)[0];
  CHECK(frame.id == 0x17F);
  CHECK(frame.size == 4);
  CHECK(frame.data[0] == 0xDE);
  CHECK(frame.data[3] == 0xEF);
}

TEST_CASE("frames with 29-bit identifiers and remote requests are ignored") {
  const auto bus = erp::open_bus(vcan0);
  cansend("1F334455#1122");
  cansend("123#R");
  cansend("124#01");
  CHECK(collect(*bus, 1)[0].id == 0x124);
}

TEST_CASE("start and end of bus-off are detected from the controller's error frames") {
  const auto bus = erp::open_bus(vcan0);
  erp::CanFrame frame;
  cansend("20000040#0000000000000000");  // CAN_ERR_BUSOFF
  while (!bus->counters().off()) CHECK(bus->receive({&frame, 1}, 10) == 0);
  CHECK(bus->counters().errors == 1);
  const auto refused = numbered(1);
  CHECK(bus->send({&refused, 1}) == 0);  // the kernel would accept and discard the frame
  cansend("20000100#0000000000000000");  // CAN_ERR_RESTARTED
  while (bus->counters().off()) CHECK(bus->receive({&frame, 1}, 10) == 0);
  CHECK(bus->counters().received == 0);
}

TEST_CASE("an interface that goes down is detected, and works again when it is up") {
  const auto a = erp::open_bus("socketcan:vcan1"), b = erp::open_bus("socketcan:vcan1");
  REQUIRE(std::system("ip link set vcan1 down") == 0);
  const auto frame = numbered(3);
  erp::CanFrame extra;
  CHECK(a->receive({&extra, 1}, 10) == 0);
  CHECK(a->counters().off());
  CHECK(a->send({&frame, 1}) == 0);
  CHECK(a->counters().refused == 1);
  REQUIRE(std::system("ip link set vcan1 up") == 0);
  CHECK(b->receive({&extra, 1}, 10) == 0);  // reports that it was down
  CHECK(a->send({&frame, 1}) == 1);
  CHECK(same(collect(*b, 1)[0], frame));
  CHECK_FALSE(b->counters().off());
}

TEST_CASE("an interface that is missing, down or not CAN is refused with the remedy") {
  using Catch::Contains;
  CHECK_THROWS_WITH(erp::open_bus("socketcan:can7"),
                    Contains("no interface \"can7\"; `ip -br link show type can`"));
  CHECK_THROWS_WITH(erp::open_bus("socketcan:lo"), Contains("\"lo\" is not a CAN interface"));
  CHECK_THROWS_WITH(erp::open_bus("socketcan:vcan2"),
                    Contains("interface \"vcan2\" is down; `ip link set vcan2 up"));
}

// ---- CAN FD: vcan3, vcan4 ----

TEST_CASE("a robot runs in lockstep over CAN FD, its frames in bundles") {
  runs_in_lockstep("socketcan:vcan3", {.fd = true});
}

TEST_CASE("over CAN FD six commands are sent in one frame") {
  const auto host = erp::open_bus("socketcan:vcan3", {.fd = true}),
             robot = erp::open_bus("socketcan:vcan3", {.fd = true});
  std::vector<erp::CanFrame> commands(6);
  for (std::uint8_t ecu = 0; ecu < 6; ++ecu) {
    const frame_command content{{{3, ecu}, {FRAME_REQUEST_NONE, 0}}, 0, 0};
    frame_pack_command(&commands[ecu], ecu, &content);
  }
  REQUIRE(host->send(commands) == 6);
  CHECK(host->in_flight() == 1);
  const auto received = collect(*robot, 6);
  for (std::size_t i = 0; i < 6; ++i) CHECK(same(received[i], commands[i]));
  erp::CanFrame extra;
  CHECK(host->receive({&extra, 1}, 10) == 0);
  CHECK(host->in_flight() == 0);
}

TEST_CASE("an interface without CAN FD is refused for a bus planned with CAN FD") {
  CHECK_THROWS_WITH(erp::open_bus(vcan0, {.fd = true}),
                    Catch::Contains("interface \"vcan0\" does not carry CAN FD; `ip link set"));
}

// ---- frames in flight, traces ----

TEST_CASE("no more frames are in flight than the window allows") {
  const auto bus = erp::open_bus(vcan0, {.window = 4});
  std::vector<erp::CanFrame> frames;
  for (unsigned n = 0; n < 6; ++n) frames.push_back(numbered(n));
  CHECK(bus->send(frames) == 4);
  CHECK(bus->in_flight() == 4);
  CHECK(bus->send(frames) == 0);
  CHECK(bus->counters().refused == 8);
  erp::CanFrame extra;
  CHECK(bus->receive({&extra, 1}, 10) == 0);
  CHECK(bus->in_flight() == 0);
  CHECK(bus->send(frames) == 4);
}

TEST_CASE("the trace of TraceWriter equals candump's, line by line") {
  REQUIRE(std::system(
              "candump -L vcan1 > /run/candump.log & echo $! > /run/candump.pid; sleep 1") == 0);
  const auto a = erp::open_bus("socketcan:vcan1"), b = erp::open_bus("socketcan:vcan1");
  {
    erp::TraceWriter trace("/run/ours.log", "vcan1");
    a->record(&trace);
    std::vector<erp::CanFrame> frames;
    for (unsigned n = 0; n < 40; ++n) frames.push_back(numbered(n));
    a->send(frames);
    collect(*b, 40);
    b->send(frames);
    collect(*a, 40);
    erp::CanFrame extra;
    a->receive({&extra, 1}, 0);
    a->record(nullptr);
  }
  REQUIRE(std::system("sleep 1; kill $(cat /run/candump.pid); sleep 1") == 0);
  CHECK(std::system("test $(wc -l < /run/ours.log) = 80") == 0);
  CHECK(std::system("diff /run/ours.log /run/candump.log") == 0);
}

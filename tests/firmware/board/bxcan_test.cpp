#include "firmware/board/cortex_m/bxcan.h"

#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <cstddef>
#include <memory>
#include <thread>

// The driver on memory that replaces the controller's registers. The tests compare its register
// accesses with RM0090. They do not check that a controller behaves as the manual states.
namespace {

static_assert(offsetof(bxcan_registers, BTR) == 0x1C);
static_assert(offsetof(bxcan_registers, mailbox) == 0x180);
static_assert(offsetof(bxcan_registers, fifo) == 0x1B0);
static_assert(offsetof(bxcan_registers, FMR) == 0x200);
static_assert(offsetof(bxcan_registers, FA1R) == 0x21C);
static_assert(offsetof(bxcan_registers, filter) == 0x240);

/// Registers that acknowledge like the controller: INAK follows INRQ.
class Controller {
 public:
  Controller() : thread_([this] { run(); }) {
    registers_->MCR = 1;  // the thread runs when it has acknowledged this
    while (registers_->MSR == 0) std::this_thread::yield();
  }
  ~Controller() {
    done_ = true;
    thread_.join();
  }
  bxcan_registers& registers() { return *registers_; }

 private:
  void run() {
    while (!done_) registers_->MSR = registers_->MCR & 1u;
  }
  std::unique_ptr<bxcan_registers> registers_ = std::make_unique<bxcan_registers>();
  std::atomic<bool> done_ = false;
  std::thread thread_;
};

bxcan_registers silent_controller() { return {}; }

/// The driver waits about 0.1 ms for the controller's thread, which may be delayed on a busy
/// machine.
bool opens_within_a_minute(bxcan_registers& can, std::uint8_t address) {
  using namespace std::chrono_literals;
  for (int attempts = 0; attempts < 60'000; ++attempts) {
    if (bxcan_open(&can, BXCAN_BTR_1_MBIT_42_MHZ, address)) return true;
    std::this_thread::sleep_for(1ms);
  }
  return false;
}

}  // namespace

TEST_CASE("bxcan_open sets the bit timing and filters for the own address and for all ECUs") {
  Controller controller;
  bxcan_registers& can = controller.registers();
  REQUIRE(opens_within_a_minute(can, 0x25));
  CHECK(can.BTR == 0x00290002);  // 42 MHz / 3 / (1 + 10 + 3) = 1 Mbit/s
  CHECK(can.MCR == (1u << 6 | 1u << 5));
  CHECK(can.FMR == 0);
  CHECK(can.FA1R == 0b11);
  CHECK(can.FS1R == 0b11);
  CHECK(can.FM1R == 0);
  for (const auto& [bank, address] : {std::pair{0, 0x25u}, {1, 0x7Fu}}) {
    CHECK(can.filter[bank].FR1 == address << 21);
    CHECK(can.filter[bank].FR2 == (0x7Fu << 21 | 0b110));  // neither extended nor remote frames
  }
}

TEST_CASE("bxcan_open fails when the controller does not answer") {
  auto can = silent_controller();
  CHECK_FALSE(bxcan_open(&can, BXCAN_BTR_1_MBIT_42_MHZ, 1));
}

TEST_CASE("a frame is written to the first free mailbox, the transmit request last") {
  auto can = silent_controller();
  const bus_frame frame{0x181, 8, {1, 2, 3, 4, 5, 6, 7, 8}};
  CHECK_FALSE(bxcan_send(&can, &frame));  // no mailbox is free
  can.TSR = 1u << 27;                     // the second one is free
  REQUIRE(bxcan_send(&can, &frame));
  CHECK(can.mailbox[0].TIR == 0);
  CHECK(can.mailbox[1].TIR == (0x181u << 21 | 1u));
  CHECK(can.mailbox[1].TDTR == 8);
  CHECK(can.mailbox[1].TDLR == 0x04030201);
  CHECK(can.mailbox[1].TDHR == 0x08070605);
}

TEST_CASE("a received frame is read and released; extended and remote frames are ignored") {
  auto can = silent_controller();
  bus_frame frame{};
  CHECK_FALSE(bxcan_receive(&can, &frame));
  can.RFR[0] = 1;
  can.fifo[0].RIR = 0x105u << 21;
  can.fifo[0].RDTR = 8;
  can.fifo[0].RDLR = 0x44332211;
  can.fifo[0].RDHR = 0x88776655;
  REQUIRE(bxcan_receive(&can, &frame));
  CHECK(frame.id == 0x105);
  CHECK(frame.size == 8);
  CHECK(frame.data[0] == 0x11);
  CHECK(frame.data[7] == 0x88);
  CHECK(can.RFR[0] == 1u << 5);
  CHECK_FALSE(bxcan_receive(&can, &frame));  // the frame is still being released
  can.RFR[0] = 1;
  can.fifo[0].RIR = 0x105u << 21 | 1u << 2;  // extended
  CHECK_FALSE(bxcan_receive(&can, &frame));
}

TEST_CASE("bus-off is read from the error register") {
  auto can = silent_controller();
  CHECK_FALSE(bxcan_is_off(&can));
  can.ESR = 1u << 2 | 255u << 16;
  CHECK(bxcan_is_off(&can));
}

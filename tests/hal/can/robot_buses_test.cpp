#include "hal/can/robot_buses.hpp"

#include <catch2/catch.hpp>

#include "hal/can/stamp_clock.hpp"
#include "tests/hal/can/link_both.hpp"

using namespace can_test;
using Catch::Contains;

namespace {

erp::Robot on_two_buses() {
  erp::Robot robot = robot_of(5);  // ECUs 3, 4, 5
  erp::BusPlan left, right;
  left.name = "left", left.ecus = {3, 5};
  right.name = "right", right.ecus = {4};
  robot.can_buses = {left, right};
  return robot;
}

erp::CanFrame frame_of(std::uint16_t function, std::uint8_t ecu) {
  return {frame_identifier(frame_function(function), ecu), 8, {}};
}

}  // namespace

TEST_CASE("a frame goes on the bus of its ECU, in order; a DISCOVER to all ECUs goes on each bus") {
  erp::BusRoutes routes(on_two_buses());
  const erp::CanFrame frames[] = {frame_of(2, 4), frame_of(2, 3), frame_of(9, FRAME_EVERYONE),
                                  frame_of(8, 5), frame_of(8, 4)};
  routes.sort(frames);
  const auto ids_on = [&](std::size_t bus) {
    std::vector<int> ids;
    for (const auto& frame : routes.on(bus)) ids.push_back(frame.id);
    return ids;
  };
  CHECK(ids_on(0) == std::vector<int>{frames[1].id, frames[2].id, frames[3].id});
  CHECK(ids_on(1) == std::vector<int>{frames[0].id, frames[2].id, frames[4].id});
  CHECK(routes.name(1) == "right");
}

TEST_CASE("a robot without a bus plan has one bus with all its ECUs") {
  const erp::BusRoutes routes(robot_of(5));
  CHECK(routes.count() == 1);
  CHECK(std::vector(routes.ecus(0).begin(), routes.ecus(0).end()) == std::vector{3, 4, 5});
}

TEST_CASE("the last number of one specification increases from bus to bus") {
  using Words = std::vector<std::string>;
  CHECK(erp::bus_specifications("socketcan:can0", 3) ==
        Words{"socketcan:can0", "socketcan:can1", "socketcan:can2"});
  CHECK(erp::bus_specifications("udp:239.255.42.1:20009", 2) ==
        Words{"udp:239.255.42.1:20009", "udp:239.255.42.1:20010"});
  CHECK(erp::bus_specifications("socketcan:b socketcan:a", 2) ==
        Words{"socketcan:b", "socketcan:a"});
  CHECK(erp::bus_specifications("trace:run.log", 7) == Words{"trace:run.log"});
  CHECK_THROWS_WITH(erp::bus_specifications("socketcan:left", 2),
                    Contains("does not end in a number"));
  CHECK_THROWS_WITH(erp::bus_specifications("a b", 3),
                    Contains("plans 3 buses, \"a b\" names 2; give one per bus"));
}

TEST_CASE("a frame to an ECU is sent on its bus only") {
  const auto robot = on_two_buses();
  const std::string where = free_udp_bus() + " " + free_udp_bus();
  const auto host = erp::open_buses(robot, where, 2), ecus = erp::open_buses(robot, where);
  const auto frame = frame_of(2, 4);
  host[1]->send({&frame, 1});
  CHECK(collect(*ecus[1], 1)[0].id == frame.id);
  erp::CanFrame frame_received;
  CHECK(ecus[0]->receive({&frame_received, 1}, 0) == 0);
}

TEST_CASE("a controller's clock is aligned with the system clock by the smallest delay") {
  erp::can::StampClock clock;
  const std::int64_t ms = 1'000'000, start = 1'700'000'000'000 * ms;
  std::int64_t worst_ns = 0;
  for (int k = 0; k < 20'000; ++k) {
    const std::int64_t on_wire = start + k * 2 * ms;
    const std::int64_t drift_ns = k * 2 * 50;                   // 50 ppm
    const std::int64_t delay_ns = 20'000 + 7919 * k % 400'000;  // delay until the kernel's stamp
    const auto stamp = clock.stamp_ns(on_wire + delay_ns, k * 2 * ms + drift_ns + 12345);
    if (k > 500) worst_ns = std::max(worst_ns, std::abs(stamp - on_wire));
  }
  CHECK(worst_ns < 1'100'000);  // delays of up to 400 µs, and 1 ms of drift in 20 s
  CHECK(clock.stamp_ns(77, 0) == 77);
}

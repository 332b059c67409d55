#include "hal/can/load.hpp"

#include <catch2/catch.hpp>

#include "interfaces/xml/errors.hpp"
#include "tests/hal/can/rig.hpp"

using namespace can_test;

namespace {

/// `ecus` ECUs with two channels each, on one bus.
erp::Robot on_one_bus(int ecus) {
  erp::Robot robot = robot_of(2 * ecus);
  robot.joint_sensors.clear();
  robot.can_buses = robot.buses();
  return robot;
}

double share(const erp::Robot& robot) { return erp::bus_loads(robot).at(0).share; }

}  // namespace

TEST_CASE("a classic frame takes at most 135 bits with 8 bytes and 55 with none") {
  CHECK(erp::frame_time_s(8, 1e6) == Approx(135e-6));
  CHECK(erp::frame_time_s(0, 1e6) == Approx(55e-6));
  CHECK(erp::frame_time_s(8, 5e5) == Approx(270e-6));
}

TEST_CASE("a CAN FD frame sends its identifier at the nominal rate and its data at the data rate") {
  // 34 bits at 1 Mbit/s; (5 + 512) + 129 + 32 = 678 bits at 5 Mbit/s
  CHECK(erp::fd_frame_time_s(64, 1e6, 5e6) == Approx(34e-6 + 678 / 5e6));
  // (5 + 96) + 25 + 27 = 153
  CHECK(erp::fd_frame_time_s(12, 1e6, 5e6) == Approx(34e-6 + 153 / 5e6));
}

TEST_CASE("an ECU with two channels needs three frames per period and a HEALTH every 25") {
  CHECK(share(on_one_bus(1)) == Approx((3 + 1.0 / 25) * 135e-6 / 0.002));
  CHECK(share(on_one_bus(4)) == Approx(4 * share(on_one_bus(1))));
  auto with_sensors = on_one_bus(1);
  for (int input : {0, 1, 3}) {
    erp::JointSensor sensor;
    sensor.ecu = 3, sensor.input = input;
    with_sensors.joint_sensors.push_back(sensor);
  }
  CHECK(share(with_sensors) == Approx((5 + 1.0 / 25) * 135e-6 / 0.002));
}

TEST_CASE("four ECUs fit on a classic bus; five are refused with place and remedy") {
  CHECK_NOTHROW(erp::refuse_overload(on_one_bus(4)));
  auto five = on_one_bus(5);
  five.can_buses[0].place = {"robot.xml", 7, 3};
  CHECK_THROWS_WITH(erp::refuse_overload(five),
                    Catch::Contains("robot.xml:7:3: <can_bus>: bus \"can\" would be busy 103 % of "
                                    "its time, more than 90 %; spread its 5 ECUs over more buses"));
  five.can_buses[0].data_bitrate_per_s = 5e6;
  CHECK_NOTHROW(erp::refuse_overload(five));
  five.can_buses.clear();
  CHECK_NOTHROW(erp::refuse_overload(five));  // no bus plan
}

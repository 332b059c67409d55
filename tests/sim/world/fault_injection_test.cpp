// Injected faults of a simulated robot trip its ECUs with the matching cause.
#include "sim/world/fault_injection.hpp"

#include <catch2/catch.hpp>

#include "interfaces/xml/values.hpp"
#include "tests/sim/rigs.hpp"
#include "tests/sim/world/limb.hpp"

namespace {

using sim::FaultKind;
using sim::InjectedFault;

constexpr double tick_s = 0.002, at_s = 1.25;  // in the middle of a stroke

/// The rig with the sensors that its ECU needs to detect every fault: potentiometers, and force
/// sensors with a live zero.
erp::Robot rig_with_all_sensors() {
  erp::Robot robot = erp::read_robot(rigs::config("hinge_rig/robot.xml"));
  robot.sensor_types[0].tension_noise_N = 0.1;
  robot.sensor_types[0].tension_zero_counts = 200;
  for (int k = 0; k < 2; ++k) {
    erp::Potentiometer wiper;
    wiper.actuator = robot.actuators[std::size_t(k)].name, wiper.ecu = 0, wiper.input = k + 1;
    wiper.range_rad = 20, wiper.start_rad = 10;
    robot.potentiometers.push_back(wiper);
  }
  return robot;
}

InjectedFault on_flexor(FaultKind kind) {
  InjectedFault fault;
  fault.kind = kind, fault.on = "flexor", fault.at_s = at_s;
  return fault;
}

struct Trip {
  ecu_fault fault = ECU_FAULT_NONE;
  double after_s = 0;
};

/// Moves the lines back and forth by 8 mm at 16 mm/s; returns the flexor's first fault within 0.5 s
/// of the injection.
Trip trip_of(const InjectedFault& fault) {
  const erp::Robot robot = rig_with_all_sensors();
  Limb limb(robot);
  const sim::FaultInjection faults({fault}, robot);
  limb.ecus.inject(&faults);
  while (limb.world.time_s() < at_s + 0.5) {
    const double phase = std::fmod(limb.world.time_s() / 2, 1),
                 up = phase < 0.5 ? phase : 1 - phase;
    const double line_m = 0.032 * (up - 0.25);
    limb.follow_lines({-0.004 - line_m, -0.004 + line_m});
    const ecu_channel& flexor = *limb.ecus.channels()[0];
    if (flexor.state == ECU_STATE_FAULT) return {flexor.fault, limb.world.time_s() - at_s};
  }
  return {};
}

}  // namespace

TEST_CASE("every sensor fault trips its ECU with the matching cause within the stated time") {
  const struct {
    FaultKind kind;
    ecu_fault fault;
    double within_s;
  } rows[]{{FaultKind::tension_open, ECU_FAULT_SENSOR_RANGE, 0.008},
           {FaultKind::tension_short, ECU_FAULT_SENSOR_RANGE, 0.008},
           {FaultKind::tension_stuck, ECU_FAULT_SENSOR_STUCK, 0.102},
           {FaultKind::current_stuck, ECU_FAULT_SENSOR_STUCK, 0.102},
           {FaultKind::encoder_slips, ECU_FAULT_POTENTIOMETER, 0.052},
           {FaultKind::over_current, ECU_FAULT_OVER_CURRENT, 0.004}};
  for (const auto& row : rows) {
    const Trip trip = trip_of(on_flexor(row.kind));
    INFO(xml::Codec<FaultKind>::write(row.kind));
    CHECK(trip.fault == row.fault);
    CHECK(trip.after_s > 0);
    CHECK(trip.after_s <= row.within_s + tick_s);
  }
}

TEST_CASE("an encoder with a lost phase trips and does not raise the current limit") {
  const Trip trip = trip_of(on_flexor(FaultKind::encoder_lost));
  CHECK(trip.fault != ECU_FAULT_NONE);
}

TEST_CASE("an injected fault begins and ends at its given times") {
  InjectedFault fault = on_flexor(FaultKind::tension_short);
  fault.for_s = 0.004;  // the third sample at the rail would trip
  CHECK(trip_of(fault).fault == ECU_FAULT_NONE);
  const sim::FaultInjection faults({fault}, rig_with_all_sensors());
  CHECK(faults.beginning(at_s - tick_s, tick_s).empty());
  CHECK(faults.beginning(at_s, tick_s).size() == 1);
}

TEST_CASE("a snapped tendon has tension 0") {
  const erp::Robot robot = rig_with_all_sensors();
  Limb limb(robot);
  const sim::FaultInjection faults({on_flexor(FaultKind::tendon_snaps)}, robot);
  limb.ecus.inject(&faults);
  const auto tension_N = [&](double until_s) {
    while (limb.world.time_s() < until_s) limb.follow_lines({-0.004, -0.004});
    return limb.world.actuators()[0].tension_N;
  };
  CHECK(tension_N(at_s - tick_s) > 5);
  CHECK(tension_N(at_s + 0.1) == 0);
}

TEST_CASE("a fault of an ECU program names its ECU and needs a separate ECU") {
  InjectedFault fault = on_flexor(FaultKind::busy);
  fault.for_s = 0.01;
  const sim::FaultInjection faults({fault}, rig_with_all_sensors());
  CHECK(faults.needs_separate_ecus());
  const auto due = faults.program_faults(at_s, tick_s);
  REQUIRE(due.size() == 1);
  CHECK((due[0].kind == FaultKind::busy && due[0].ecu == 0 && due[0].periods == 5));
  CHECK(faults.program_faults(at_s + tick_s, tick_s).empty());
  fault.on = "biceps";
  CHECK_THROWS_WITH(sim::FaultInjection({fault}, rig_with_all_sensors()),
                    Catch::Contains("biceps"));
}

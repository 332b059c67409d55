// What breaks in a simulated robot is what its ECUs trip of.
#include "sim/world/mishaps.hpp"

#include <catch2/catch.hpp>

#include "interfaces/xml/values.hpp"
#include "tests/sim/rigs.hpp"
#include "tests/sim/world/limb.hpp"

namespace {

using sim::Mishap;
using sim::MishapKind;

constexpr double tick_s = 0.002, at_s = 1.25;  // in the middle of a stroke

/// The rig with what its ECU needs to tell every fault: potentiometers, and force sensors with a
/// live zero.
erp::Robot watched_rig() {
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

Mishap on_flexor(MishapKind kind) {
  Mishap mishap;
  mishap.kind = kind, mishap.on = "flexor", mishap.at_s = at_s;
  return mishap;
}

struct Trip {
  ecu_fault fault = ECU_FAULT_NONE;
  double after_s = 0;
};

/// Lines to and fro by 8 mm at 16 mm/s; the flexor's first fault within 0.5 s of the mishap.
Trip trip_of(const Mishap& mishap) {
  const erp::Robot robot = watched_rig();
  Limb limb(robot);
  const sim::Mishaps mishaps({mishap}, robot);
  limb.ecus.suffer(&mishaps);
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

TEST_CASE("every sensor that breaks trips its ECU in time, of the right cause") {
  const struct {
    MishapKind kind;
    ecu_fault fault;
    double within_s;
  } rows[]{{MishapKind::tension_open, ECU_FAULT_SENSOR_RANGE, 0.008},
           {MishapKind::tension_short, ECU_FAULT_SENSOR_RANGE, 0.008},
           {MishapKind::tension_stuck, ECU_FAULT_SENSOR_STUCK, 0.102},
           {MishapKind::current_stuck, ECU_FAULT_SENSOR_STUCK, 0.102},
           {MishapKind::encoder_slips, ECU_FAULT_POTENTIOMETER, 0.052},
           {MishapKind::over_current, ECU_FAULT_OVER_CURRENT, 0.004}};
  for (const auto& row : rows) {
    const Trip trip = trip_of(on_flexor(row.kind));
    INFO(xml::Codec<MishapKind>::write(row.kind));
    CHECK(trip.fault == row.fault);
    CHECK(trip.after_s > 0);
    CHECK(trip.after_s <= row.within_s + tick_s);
  }
}

TEST_CASE("an encoder without a phase opens no current limit: something trips") {
  const Trip trip = trip_of(on_flexor(MishapKind::encoder_lost));
  CHECK(trip.fault != ECU_FAULT_NONE);
}

TEST_CASE("a mishap begins and ends when it says") {
  Mishap mishap = on_flexor(MishapKind::tension_short);
  mishap.for_s = 0.004;  // the third sample at the rail would trip
  CHECK(trip_of(mishap).fault == ECU_FAULT_NONE);
  const sim::Mishaps mishaps({mishap}, watched_rig());
  CHECK(mishaps.beginning(at_s - tick_s, tick_s).empty());
  CHECK(mishaps.beginning(at_s, tick_s).size() == 1);
}

TEST_CASE("a tendon that snaps pulls no more") {
  const erp::Robot robot = watched_rig();
  Limb limb(robot);
  const sim::Mishaps mishaps({on_flexor(MishapKind::tendon_snaps)}, robot);
  limb.ecus.suffer(&mishaps);
  const auto tension_N = [&](double until_s) {
    while (limb.world.time_s() < until_s) limb.follow_lines({-0.004, -0.004});
    return limb.world.actuators()[0].tension_N;
  };
  CHECK(tension_N(at_s - tick_s) > 5);
  CHECK(tension_N(at_s + 0.1) == 0);
}

TEST_CASE("what befalls a program names its ECU, and needs one") {
  Mishap mishap = on_flexor(MishapKind::busy);
  mishap.for_s = 0.01;
  const sim::Mishaps mishaps({mishap}, watched_rig());
  CHECK(mishaps.needs_separate_ecus());
  const auto due = mishaps.of_ecus(at_s, tick_s);
  REQUIRE(due.size() == 1);
  CHECK((due[0].kind == MishapKind::busy && due[0].ecu == 0 && due[0].periods == 5));
  CHECK(mishaps.of_ecus(at_s + tick_s, tick_s).empty());
  mishap.on = "biceps";
  CHECK_THROWS_WITH(sim::Mishaps({mishap}, watched_rig()), Catch::Contains("biceps"));
}

// Faulty sensors, detected and handled by the firmware alone.
#include "tests/faults/bench.hpp"

using namespace faults;

namespace {

/// Injects `alter`, waits for that fault and for PWM 0 of the flexor's channel, clears.
void inject(Bench& bench, Row& safe, int fault, const PinRelay::Alter& alter,
            std::int64_t began_ns = 0) {
  bench.settle();
  const auto from = began_ns ? began_ns : bench.pins().alter(alter);
  const auto message = bench.await([&] { return bench.emergency(from, fault); });
  INFO("last reported fault: " << bench.last_fault());
  safe.also("the fault itself is reported", from, message != 0);
  safe.add(from, bench.await([&] { return bench.pwm_off(from, 0, 0); }));
  bench.pins().leave_alone();
  bench.say_off();
}

}  // namespace

TEST_CASE("force sensor open, short") {
  Bench bench;
  Row open("force sensor open", "PWM 0", 8), shorted("force sensor short", "PWM 0", 8);
  while (open.needs_more() || shorted.needs_more()) {
    inject(bench, open, ECU_FAULT_SENSOR_RANGE,
           [](int, board_readings& r) { r.channel[0].tension_counts = 4095; });
    inject(bench, shorted, ECU_FAULT_SENSOR_RANGE,
           [](int, board_readings& r) { r.channel[0].tension_counts = 0; });
  }
  open.check(), shorted.check();
}

TEST_CASE("sensor stuck") {
  tests::Folder folder;
  write_rig(folder, 0.008);
  Bench bench(folder / "robot.xml", folder / "graph.xml");
  for (const bool tension : {true, false}) {
    Row safe(tension ? "force sensor stuck" : "current sensor stuck", "PWM 0, turning at once",
             102);
    while (safe.needs_more()) {
      bench.settle();
      // Start just after a reversal of the triangle: the shaft then turns for longer than 100 ms.
      std::optional<ecu_inputs> kept;
      std::optional<std::int32_t> last;
      std::int64_t from = 0;
      int turning = 0;
      bool turned_back = false;
      std::mutex guard;
      const auto began = node::wall_ns();
      bench.pins().alter([&](int, board_readings& r) {
        const std::lock_guard lock(guard);
        ecu_inputs& in = r.channel[0];
        const int moved = std::abs(in.encoder_counts - last.value_or(in.encoder_counts - 1000));
        last = in.encoder_counts;
        turning = moved > 150 ? turning + 1 : 0;  // of 41721 counts a radian: 1.8 rad/s
        turned_back = turned_back || turning == 0;
        if (!kept && turned_back && turning == 20) kept = in, from = node::wall_ns();
        if (!kept) return;
        if (tension) in.tension_counts = kept->tension_counts;
        else in.current_counts = kept->current_counts;
      });
      const auto message = bench.await([&] { return bench.emergency(1, ECU_FAULT_SENSOR_STUCK); });
      if (from == 0 && !safe.kept_time(began, node::wall_ns()))
        safe.discard();  // it tripped before
      else {
        safe.also("the fault itself is reported", from, message != 0);
        safe.add(from, bench.await([&] { return bench.pwm_off(from, 0, 0); }));
      }
      bench.pins().leave_alone();
      bench.say_off();
    }
    safe.check();
  }
}

TEST_CASE("encoder slips") {
  Bench bench;
  Row safe("encoder phase lost (slips)", "PWM 0", 52);
  while (safe.needs_more(std::min(5, injections()))) {
    // Evidence of the potentiometer against the encoder survives a clear; only a reset removes it.
    inject(bench, safe, ECU_FAULT_POTENTIOMETER,
           [](int, board_readings& r) { r.channel[0].encoder_counts += 41721 / 6; });
    const auto from = node::wall_ns();
    kill(bench.ecu(0), SIGKILL);
    REQUIRE(bench.await([&] { return bench.boot(from, FRAME_RESET_BROWN_OUT); }) != 0);
  }
  safe.check();
}

TEST_CASE("over-current") {
  Bench bench;
  Row safe("over-current", "PWM 0", 4);
  while (safe.needs_more())
    inject(bench, safe, ECU_FAULT_OVER_CURRENT,
           [](int, board_readings& r) { r.channel[0].current_counts = 1900; });
  safe.check();
}

TEST_CASE("over-temperature") {
  Bench bench;
  node::Writer<erp::GainCommand> gains(bench.participant());
  erp::GainCommand command;
  erp::assign(command.robot, bench.robot().name);
  erp::assign(command.controller, "hand");
  for (const auto& [name, value] : {std::pair{"temperature_C_per_count", 0.1},
                                    {"temperature_derate_C", 70.0},
                                    {"temperature_trip_C", 90.0}}) {
    erp::GainValue gain{};
    erp::assign(gain.name, "flexor");
    erp::assign(gain.parameter, name);
    gain.value = value;
    erp::append(command.gains, gain);
  }
  tests::wait_until([&] { return gains.matched() > 0; });
  gains.write(command);
  std::this_thread::sleep_for(300ms);
  Row safe("over-temperature", "PWM 0", 100 + 2);
  while (safe.needs_more(std::min(5, injections())))
    inject(bench, safe, ECU_FAULT_OVER_TEMPERATURE,
           [](int, board_readings& r) { r.channel[0].temperature_counts = 950; });
  safe.check();
}

TEST_CASE("loop overrun, and bus-off at an ECU") {
  Bench bench;
  // Three periods of 2 ms and one tick to detect, from the start of the first overrun.
  Row overrun("loop overrun, three in a row", "PWM 0", 3 * 2 + 2);
  Row off("bus-off at an ECU", "PWM 0", 4),
      rejoined("bus-off at an ECU", "rejoined, disarmed", 100);
  while (overrun.needs_more() || off.needs_more()) {
    bench.settle();
    auto from = bench.pins().inject(0, WIRE_FAULT_BUSY, 6);
    from = bench.await([&] { return bench.next_period(from); });
    const auto reported = bench.await([&] { return bench.emergency(from, ECU_FAULT_OVERRUN); });
    overrun.also("the fault itself is reported", from, reported != 0);
    overrun.add(from, bench.await([&] { return bench.pwm_off(from); }));
    bench.say_off();

    bench.settle();
    from = bench.pins().inject(0, WIRE_FAULT_BUS_OFF, 10);
    off.add(from, bench.await([&] { return bench.pwm_off(from); }));
    const auto back = bench.await([&] {
      return bench.bus_recorder().first(from + 15 * ms, [](const erp::CanFrame& frame) {
        frame_status message;
        return frame_unpack_status(&frame, &message) && message.state != ECU_STATE_RUNNING;
      });
    });
    rejoined.add(from, back);
  }
  overrun.check(), off.check(), rejoined.check();
}

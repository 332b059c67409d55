// Sensor faults that the firmware detects and handles without the host.
#include "tests/faults/bench.hpp"

using namespace faults;

namespace {

/// Injects `alter`, waits for the fault and for PWM 0 of the flexor's channel, and clears the
/// fault.
void inject(Bench& bench, ReactionTimes& pwm_off, int fault, const PinRelay::Alter& alter,
            std::int64_t injected_ns = 0) {
  bench.settle();
  const auto start_ns = injected_ns ? injected_ns : bench.pins().alter(alter);
  const auto message = bench.wait_for([&] { return bench.emergency(start_ns, fault); });
  INFO("last reported fault: " << bench.last_fault());
  pwm_off.require("the injected fault is reported", start_ns, message != 0);
  pwm_off.add(start_ns, bench.wait_for([&] { return bench.pwm_off(start_ns, 0, 0); }));
  bench.pins().pass_unchanged();
  bench.command_off();
}

}  // namespace

TEST_CASE("an open or shorted force sensor sets PWM to 0 within 8 ms") {
  Bench bench;
  ReactionTimes open("force sensor open", "PWM 0", 8), shorted("force sensor short", "PWM 0", 8);
  while (open.needs_more() || shorted.needs_more()) {
    inject(bench, open, ECU_FAULT_SENSOR_RANGE,
           [](int, board_readings& r) { r.channel[0].tension_counts = 4095; });
    inject(bench, shorted, ECU_FAULT_SENSOR_RANGE,
           [](int, board_readings& r) { r.channel[0].tension_counts = 0; });
  }
  open.check(), shorted.check();
}

TEST_CASE("a stuck force or current sensor sets PWM to 0 within 102 ms of rotation") {
  tests::Folder folder;
  write_rig(folder, 0.008);
  Bench bench(folder / "robot.xml", folder / "graph.xml");
  for (const bool tension : {true, false}) {
    ReactionTimes pwm_off(tension ? "force sensor stuck" : "current sensor stuck",
                          "PWM 0, turning at once", 102);
    while (pwm_off.needs_more()) {
      bench.settle();
      // Start just after a reversal of the triangle: the shaft then turns for longer than 100 ms.
      std::optional<ecu_inputs> stuck_inputs;
      std::optional<std::int32_t> last_counts;
      std::int64_t start_ns = 0;
      int turning = 0;
      bool was_reversed = false;
      std::mutex guard;
      const auto began = node::wall_ns();
      bench.pins().alter([&](int, board_readings& r) {
        const std::lock_guard lock(guard);
        ecu_inputs& in = r.channel[0];
        const int moved_counts =
            std::abs(in.encoder_counts - last_counts.value_or(in.encoder_counts - 1000));
        last_counts = in.encoder_counts;
        turning = moved_counts > 150 ? turning + 1
                                     : 0;  // counts per period; 41721 counts per radian: 1.8 rad/s
        was_reversed = was_reversed || turning == 0;
        if (!stuck_inputs && was_reversed && turning == 20)
          stuck_inputs = in, start_ns = node::wall_ns();
        if (!stuck_inputs) return;
        if (tension) in.tension_counts = stuck_inputs->tension_counts;
        else in.current_counts = stuck_inputs->current_counts;
      });
      const auto message =
          bench.wait_for([&] { return bench.emergency(1, ECU_FAULT_SENSOR_STUCK); });
      if (start_ns == 0 && !pwm_off.machine_kept_time(began, node::wall_ns()))
        pwm_off.discard();  // the channel tripped before the injection
      else {
        pwm_off.require("the injected fault is reported", start_ns, message != 0);
        pwm_off.add(start_ns, bench.wait_for([&] { return bench.pwm_off(start_ns, 0, 0); }));
      }
      bench.pins().pass_unchanged();
      bench.command_off();
    }
    pwm_off.check();
  }
}

TEST_CASE("a slipping encoder sets PWM to 0 within 52 ms") {
  Bench bench;
  ReactionTimes pwm_off("encoder phase lost (slips)", "PWM 0", 52);
  while (pwm_off.needs_more(std::min(5, injections()))) {
    // The reference of the potentiometer is kept over a clear; only a reset clears it.
    inject(bench, pwm_off, ECU_FAULT_POTENTIOMETER,
           [](int, board_readings& r) { r.channel[0].encoder_counts += 41721 / 6; });
    const auto start_ns = node::wall_ns();
    kill(bench.ecu(0), SIGKILL);
    REQUIRE(bench.wait_for([&] { return bench.boot(start_ns, FRAME_RESET_BROWN_OUT); }) != 0);
  }
  pwm_off.check();
}

TEST_CASE("over-current sets PWM to 0 within 4 ms") {
  Bench bench;
  ReactionTimes pwm_off("over-current", "PWM 0", 4);
  while (pwm_off.needs_more())
    inject(bench, pwm_off, ECU_FAULT_OVER_CURRENT,
           [](int, board_readings& r) { r.channel[0].current_counts = 1900; });
  pwm_off.check();
}

TEST_CASE("over-temperature sets PWM to 0 within 102 ms") {
  Bench bench;
  node::Writer<erp::GainCommand> gains(bench.participant());
  erp::GainCommand command;
  erp::assign(command.robot, bench.robot().name);
  erp::assign(command.controller, "hand");
  command.priority = 1;  // above the controller that drives the actuator
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
  const auto sent_ns = node::wall_ns();
  gains.write(command);
  REQUIRE(bench.wait_for([&] { return bench.events().first(sent_ns, "gains", "flexor"); }) != 0);
  ReactionTimes pwm_off("over-temperature", "PWM 0", 100 + 2);
  while (pwm_off.needs_more(std::min(5, injections())))
    inject(bench, pwm_off, ECU_FAULT_OVER_TEMPERATURE,
           [](int, board_readings& r) { r.channel[0].temperature_counts = 950; });
  pwm_off.check();
}

TEST_CASE("three loop overruns set PWM to 0 within 8 ms, bus-off at an ECU within 4 ms") {
  Bench bench;
  // Three periods of 2 ms and one tick to detect, from the start of the first overrun.
  ReactionTimes overrun("three consecutive loop overruns", "PWM 0", 3 * 2 + 2);
  ReactionTimes bus_off_pwm("bus-off at an ECU", "PWM 0", 4),
      rejoined("bus-off at an ECU", "rejoined, disarmed", 100);
  while (overrun.needs_more() || bus_off_pwm.needs_more()) {
    bench.settle();
    auto start_ns = bench.pins().inject(0, WIRE_FAULT_BUSY, 6);
    start_ns = bench.wait_for([&] { return bench.next_period(start_ns); });
    const auto reported =
        bench.wait_for([&] { return bench.emergency(start_ns, ECU_FAULT_OVERRUN); });
    overrun.require("the injected fault is reported", start_ns, reported != 0);
    overrun.add(start_ns, bench.wait_for([&] { return bench.pwm_off(start_ns); }));
    bench.command_off();

    bench.settle();
    start_ns = bench.pins().inject(0, WIRE_FAULT_BUS_OFF, 10);
    bus_off_pwm.add(start_ns, bench.wait_for([&] { return bench.pwm_off(start_ns); }));
    const auto rejoined_ns = bench.wait_for([&] {
      return bench.bus_recorder().first(start_ns + 15 * ms, [](const erp::CanFrame& frame) {
        frame_status message;
        return frame_unpack_status(&frame, &message) && message.state != ECU_STATE_RUNNING;
      });
    });
    rejoined.add(start_ns, rejoined_ns);
  }
  overrun.check(), bus_off_pwm.check(), rejoined.check();
}

// Processes are killed, stopped and restarted, twenty times each.
#include <algorithm>

#include "components/node/log_throttle.hpp"
#include "tests/faults/bench.hpp"

using namespace faults;

namespace {

/// The arm at rest under length control; its safe action is to relax, which is visible on the bus.
void write_relaxing_arm(const tests::Folder& folder) {
  std::string robot = tests::content(ERP_SOURCE_DIR "/configs/arm/robot.xml");
  const std::string hold = "safe_action=\"hold\"", relax = "safe_action=\"relax\"";
  for (std::size_t at = 0; (at = robot.find(hold)) != std::string::npos;)
    robot.replace(at, hold.size(), relax);
  std::ofstream(folder / "robot.xml") << robot;
  const std::string configs = ERP_SOURCE_DIR "/configs/arm/";
  std::ifstream moving(configs + "lengths.csv");
  std::string head, first;
  std::getline(moving, head), std::getline(moving, first);
  std::ofstream(folder / "lengths.csv")
      << head << '\n'
      << first << "\n1000" << first.substr(first.find(',')) << '\n';
  std::ofstream(folder / "target.xml") << "<target file=\"lengths.csv\"/>\n";
  std::ofstream(folder / "graph.xml") << "<graph name=\"arm\" robot=\"robot.xml\" device=\"can\">\n"
                                      << "  <component name=\"target\" config=\"target.xml\"/>\n"
                                      << "  <component name=\"length_control\" config=\"" << configs
                                      << "length_control.xml\"/>\n</graph>\n";
}

bool is_command(const erp::CanFrame& frame) { return frame_function_of(&frame) == FRAME_COMMAND; }

/// The rig's safe action: force mode at 2 N on both channels.
bool relaxes(const erp::CanFrame& frame) {
  frame_command emergency;
  if (!frame_unpack_command(&frame, &emergency)) return false;
  return std::ranges::all_of(emergency.channel, [](const frame_channel_command& c) {
    return c.request == ECU_REQUEST_FORCE && c.setpoint == 2000;
  });
}

}  // namespace

TEST_CASE("after the gateway is killed the ECUs set PWM to 0 within 52 ms") {
  ReactionTimes::print_header();
  Bench bench;
  ReactionTimes emergency("gateway killed", "ECU's emergency frame", 52),
      pwm_off("gateway killed", "PWM 0", 52);
  while (pwm_off.needs_more()) {
    bench.settle();
    const pid_t gateway = bench.process("gateway");
    const auto injected_ns = node::wall_ns();
    kill(gateway, SIGKILL);
    emergency.add(injected_ns, bench.wait_for([&] {
      return bench.emergency(injected_ns, ECU_FAULT_COMMAND_TIMEOUT);
    }));
    pwm_off.add(injected_ns, bench.wait_for([&] { return bench.pwm_off(injected_ns); }));
  }
  emergency.check(), pwm_off.check();
  bench.settle();
}

TEST_CASE("while the gateway is stopped PWM is 0; when it resumes it sends no burst") {
  Bench bench;
  ReactionTimes emergency("gateway stopped", "ECU's emergency frame", 52),
      pwm_off("gateway stopped", "PWM 0", 52);
  while (pwm_off.needs_more()) {
    bench.settle();
    const pid_t gateway = bench.process("gateway");
    const auto injected_ns = node::wall_ns();
    kill(gateway, SIGSTOP);
    emergency.add(injected_ns, bench.wait_for([&] {
      return bench.emergency(injected_ns, ECU_FAULT_COMMAND_TIMEOUT);
    }));
    pwm_off.add(injected_ns, bench.wait_for([&] { return bench.pwm_off(injected_ns); }));
    std::this_thread::sleep_for(200ms);
    const auto resumed_ns = node::wall_ns();
    kill(gateway, SIGCONT);
    std::this_thread::sleep_for(20ms);
    int burst = 0;
    for (const auto& received : bench.bus_recorder().since(resumed_ns))
      burst += is_command(received.frame) && received.at_ns < resumed_ns + 2 * ms;
    pwm_off.require("no burst after it resumes", resumed_ns,
                    burst <= 5);  // a hundred ticks are pending
  }
  emergency.check(), pwm_off.check();
  bench.settle();
}

/// Waits until the gateway may report this event again, because repeated reports are limited in
/// rate.
bool can_be_reported(Bench& bench, const std::string& code, const std::string& subject) {
  return tests::wait_until([&] {
    const auto recent = bench.events().since(node::wall_ns() - node::LogThrottle::window_ns);
    return std::ranges::count_if(recent, [&](const auto& emergency) {
             return emergency.code == code && emergency.subject == subject;
           }) < node::LogThrottle::burst;
  });
}

/// Time without a frame of an ECU before `at_ns`, in ns. A frame that arrived during the delay of
/// the gateway's report ends the silence. 0: no frame was received since the bench settled.
std::int64_t silence_before_ns(Bench& bench, const std::string& name, std::int64_t at_ns) {
  constexpr auto reporting_ns = std::int64_t(ReactionTimes::scheduling_ms) * ms;
  std::int64_t last_ns = 0, longest_ns = 0;
  const auto until = [&](std::int64_t next_ns) {
    if (last_ns && next_ns > at_ns - reporting_ns)
      longest_ns = std::max(longest_ns, std::min(next_ns, at_ns) - last_ns);
    last_ns = next_ns;
  };
  for (const auto& received : bench.bus_recorder().since(1))
    if (!is_command(received.frame) && received.at_ns < at_ns &&
        name == "ecu " + std::to_string(frame_ecu_of(&received.frame)))
      until(received.at_ns);
  until(at_ns);
  return longest_ns;
}

TEST_CASE("a silent ECU is reported, and its limb takes the safe action within 60 ms") {
  tests::Folder folder;
  write_relaxing_arm(folder);
  Bench bench(folder / "robot.xml", folder / "graph.xml");
  ReactionTimes warning("ECU silent", "gateway's warning", 10 + 2),
      lost("ECU silent", "gateway: lost", 50 + 2),
      safe_action("ECU silent", "its limb in the safe action", 60);
  for (int k = 0; safe_action.needs_more(); ++k) {
    const int address = k % 6;
    const std::string name = "ecu " + std::to_string(address);
    bench.settle();
    const bool is_reportable = can_be_reported(bench, "ecu_silent", name);
    const pid_t ecu = bench.ecu(address);
    const auto injected_ns = node::wall_ns();
    kill(ecu, SIGSTOP);
    const auto reported =
        bench.wait_for([&] { return bench.events().first(injected_ns, "ecu_silent", name); });
    if (is_reportable) warning.add(injected_ns, reported);
    else warning.discard();
    lost.add(injected_ns,
             bench.wait_for([&] { return bench.events().first(injected_ns, "ecu_lost", name); }));
    safe_action.add(injected_ns, bench.wait_for([&] {
      return bench.bus_recorder().first(injected_ns, [&](const erp::CanFrame& frame) {
        frame_command emergency;  // to one of the others: relax
        return frame_ecu_of(&frame) == (address + 1) % 6 &&
               frame_unpack_command(&frame, &emergency) &&
               emergency.channel[0].request == ECU_REQUEST_FORCE;
      });
    }));
    const auto is_false_report = [&](const auto& emergency) {
      return emergency.code == "ecu_silent" && emergency.subject != name &&
             silence_before_ns(bench, emergency.subject, emergency.at_ns) < 9 * ms;
    };
    safe_action.require("no ECU that sends is reported as silent", injected_ns,
                        std::ranges::none_of(bench.events().since(injected_ns), is_false_report));
    kill(ecu, SIGCONT);
  }
  warning.check(), lost.check(), safe_action.check();
  bench.settle();
}

TEST_CASE("after a brown-out PWM is 0 within 2 ms, and the boot frame has the cause") {
  Bench bench;
  ReactionTimes emergency("brown-out, reset", "boot frame with the cause", 100),
      pwm_off("brown-out, reset", "PWM 0", 2);
  while (pwm_off.needs_more()) {
    bench.settle();
    const pid_t ecu = bench.ecu(0);
    const auto injected_ns = node::wall_ns();
    kill(ecu, SIGKILL);
    const auto booted =
        bench.wait_for([&] { return bench.boot(injected_ns, FRAME_RESET_BROWN_OUT); });
    emergency.add(injected_ns, booted);
    pwm_off.add(injected_ns, bench.wait_for([&] { return bench.pwm_off(injected_ns); }));
    int armed = 0;  // in the 5 ms after its boot
    for (const auto& received : bench.bus_recorder().since(booted)) {
      frame_status status;
      armed += received.at_ns < booted + 5 * ms && frame_unpack_status(&received.frame, &status) &&
               status.state != ECU_STATE_BOOT;
    }
    CHECK(armed == 0);
  }
  emergency.check(), pwm_off.check();
  bench.settle();
}

TEST_CASE("a hanging ECU program is reset by its watchdog within 12 ms") {
  Bench bench;
  ReactionTimes pwm_off("CPU hang", "PWM 0", 12),
      emergency("CPU hang", "boot frame with the cause", 100);
  while (pwm_off.needs_more()) {
    bench.settle();
    const auto injected_ns = bench.pins().inject(0, WIRE_FAULT_HANG);
    const auto booted =
        bench.wait_for([&] { return bench.boot(injected_ns, FRAME_RESET_WATCHDOG); });
    emergency.add(injected_ns, booted);
    pwm_off.add(injected_ns, bench.wait_for([&] { return bench.pwm_off(injected_ns); }));
    int duties = 0;  // duties of a hanging program in the watchdog's 12 ms before the restart
    for (const auto& received : bench.bus_recorder().since(booted - 11 * ms))
      duties += received.at_ns < booted && !is_command(received.frame);
    pwm_off.require("the hanging program sends no frame", injected_ns, booted > 0 && duties == 0,
                    booted > 0);
  }
  pwm_off.check(), emergency.check();
  bench.settle();
}

TEST_CASE("after a controller is killed or stopped the safe action follows within 22 ms") {
  Bench bench;
  for (const int signal : {SIGKILL, SIGSTOP}) {
    const std::string fault = signal == SIGKILL ? "controller killed" : "controller stopped";
    ReactionTimes safe_action(fault, "safe action on the bus", 22);
    while (safe_action.needs_more()) {
      bench.settle();
      const pid_t controller = bench.process("length_control");
      const auto injected_ns = node::wall_ns();
      kill(controller, signal);
      safe_action.add(injected_ns, bench.wait_for([&] {
        return bench.bus_recorder().first(injected_ns, relaxes);
      }));
      CHECK(bench.owner() == "");
      if (signal == SIGSTOP) kill(controller, SIGCONT);
      CHECK(tests::wait_until([&] { return bench.owner() == "length_control"; }));
    }
    safe_action.check();
  }
  bench.settle();
}

TEST_CASE("after the plant is killed the ECUs set PWM to 0 within 52 ms") {
  Bench bench;
  ReactionTimes plant("plant killed", "ECU's emergency frame", 52),
      pwm_off("plant killed", "PWM 0", 52);
  while (pwm_off.needs_more()) {
    bench.settle();
    const pid_t pid = bench.process("plant");
    const auto injected_ns = node::wall_ns();
    kill(pid, SIGKILL);
    plant.add(injected_ns, bench.wait_for([&] {
      return bench.emergency(injected_ns, ECU_FAULT_COMMAND_TIMEOUT);
    }));
    pwm_off.add(injected_ns, bench.wait_for([&] { return bench.pwm_off(injected_ns); }));
  }
  plant.check(), pwm_off.check();
  bench.settle();
}

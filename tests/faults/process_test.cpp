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
  frame_command message;
  if (!frame_unpack_command(&frame, &message)) return false;
  return std::ranges::all_of(message.channel, [](const frame_channel_command& c) {
    return c.request == ECU_REQUEST_FORCE && c.setpoint == 2000;
  });
}

}  // namespace

TEST_CASE("gateway killed") {
  Row::head();
  Bench bench;
  Row message("gateway killed", "ECU's emergency frame", 52), off("gateway killed", "PWM 0", 52);
  while (off.needs_more()) {
    bench.settle();
    const pid_t gateway = bench.process("gateway");
    const auto from = node::wall_ns();
    kill(gateway, SIGKILL);
    message.add(from, bench.await([&] { return bench.emergency(from, ECU_FAULT_COMMAND_TIMEOUT); }));
    off.add(from, bench.await([&] { return bench.pwm_off(from); }));
  }
  message.check(), off.check();
  bench.settle();
}

TEST_CASE("gateway stopped, and no burst when it resumes") {
  Bench bench;
  Row message("gateway stopped", "ECU's emergency frame", 52), off("gateway stopped", "PWM 0", 52);
  while (off.needs_more()) {
    bench.settle();
    const pid_t gateway = bench.process("gateway");
    const auto from = node::wall_ns();
    kill(gateway, SIGSTOP);
    message.add(from, bench.await([&] { return bench.emergency(from, ECU_FAULT_COMMAND_TIMEOUT); }));
    off.add(from, bench.await([&] { return bench.pwm_off(from); }));
    std::this_thread::sleep_for(200ms);
    const auto again = node::wall_ns();
    kill(gateway, SIGCONT);
    std::this_thread::sleep_for(20ms);
    int burst = 0;
    for (const auto& received : bench.bus_recorder().since(again))
      burst += is_command(received.frame) && received.at_ns < again + 2 * ms;
    off.also("no burst after it resumes", again, burst <= 5);  // a hundred ticks are pending
  }
  message.check(), off.check();
  bench.settle();
}

/// Waits until the gateway reports again: repeated reports are limited in rate.
bool may_be_said(Bench& bench, const std::string& code, const std::string& subject) {
  return tests::wait_until([&] {
    const auto lately = bench.events().since(node::wall_ns() - node::LogThrottle::window_ns);
    return std::ranges::count_if(lately, [&](const auto& message) {
             return message.code == code && message.subject == subject;
           }) < node::LogThrottle::burst;
  });
}

/// How long an ECU had sent nothing before `at_ns`: up to then, or up to a frame that arrived while the
/// gateway was about to report. 0: not received since the bench settled.
std::int64_t silent_for(Bench& bench, const std::string& name, std::int64_t at_ns) {
  constexpr auto reporting_ns = std::int64_t(Row::scheduling_ms) * ms;
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

TEST_CASE("ECU silent") {
  tests::Folder folder;
  write_relaxing_arm(folder);
  Bench bench(folder / "robot.xml", folder / "graph.xml");
  Row warned("ECU silent", "gateway's warning", 10 + 2),
      lost("ECU silent", "gateway: lost", 50 + 2),
      safe("ECU silent", "its limb in the safe action", 60);
  for (int k = 0; safe.needs_more(); ++k) {
    const int address = k % 6;
    const std::string name = "ecu " + std::to_string(address);
    bench.settle();
    const bool sayable = may_be_said(bench, "ecu_silent", name);
    const pid_t ecu = bench.ecu(address);
    const auto from = node::wall_ns();
    kill(ecu, SIGSTOP);
    const auto reported = bench.await([&] { return bench.events().first(from, "ecu_silent", name); });
    if (sayable) warned.add(from, reported);
    else warned.discard();
    lost.add(from, bench.await([&] { return bench.events().first(from, "ecu_lost", name); }));
    safe.add(from, bench.await([&] {
      return bench.bus_recorder().first(from, [&](const erp::CanFrame& frame) {
        frame_command message;  // to one of the others: relax
        return frame_ecu_of(&frame) == (address + 1) % 6 && frame_unpack_command(&frame, &message) &&
               message.channel[0].request == ECU_REQUEST_FORCE;
      });
    }));
    const auto slanders = [&](const auto& message) {
      return message.code == "ecu_silent" && message.subject != name &&
             silent_for(bench, message.subject, message.at_ns) < 9 * ms;
    };
    safe.also("nobody is called silent who spoke", from,
              std::ranges::none_of(bench.events().since(from), slanders));
    kill(ecu, SIGCONT);
  }
  warned.check(), lost.check(), safe.check();
  bench.settle();
}

TEST_CASE("brown-out") {
  Bench bench;
  Row message("brown-out, reset", "boot frame with the cause", 100),
      off("brown-out, reset", "PWM 0", 2);
  while (off.needs_more()) {
    bench.settle();
    const pid_t ecu = bench.ecu(0);
    const auto from = node::wall_ns();
    kill(ecu, SIGKILL);
    const auto booted = bench.await([&] { return bench.boot(from, FRAME_RESET_BROWN_OUT); });
    message.add(from, booted);
    off.add(from, bench.await([&] { return bench.pwm_off(from); }));
    int armed = 0;  // in the 5 ms after its boot
    for (const auto& received : bench.bus_recorder().since(booted)) {
      frame_status status;
      armed += received.at_ns < booted + 5 * ms && frame_unpack_status(&received.frame, &status) &&
               status.state != ECU_STATE_BOOT;
    }
    CHECK(armed == 0);
  }
  message.check(), off.check();
  bench.settle();
}

TEST_CASE("CPU hang") {
  Bench bench;
  Row off("CPU hang", "PWM 0", 12), message("CPU hang", "boot frame with the cause", 100);
  while (off.needs_more()) {
    bench.settle();
    const auto from = bench.pins().inject(0, WIRE_FAULT_HANG);
    const auto booted = bench.await([&] { return bench.boot(from, FRAME_RESET_WATCHDOG); });
    message.add(from, booted);
    off.add(from, bench.await([&] { return bench.pwm_off(from); }));
    int duties = 0;  // duties of a hanging program in the watchdog's 12 ms before the restart
    for (const auto& received : bench.bus_recorder().since(booted - 11 * ms))
      duties += received.at_ns < booted && !is_command(received.frame);
    off.also("it sends nothing more", from, booted > 0 && duties == 0, booted > 0);
  }
  off.check(), message.check();
  bench.settle();
}

TEST_CASE("controller killed, and stopped") {
  Bench bench;
  for (const int signal : {SIGKILL, SIGSTOP}) {
    const std::string fault = signal == SIGKILL ? "controller killed" : "controller stopped";
    Row safe(fault, "safe action on the bus", 22);
    while (safe.needs_more()) {
      bench.settle();
      const pid_t controller = bench.process("length_control");
      const auto from = node::wall_ns();
      kill(controller, signal);
      safe.add(from, bench.await([&] { return bench.bus_recorder().first(from, relaxes); }));
      CHECK(bench.owner() == "");
      if (signal == SIGSTOP) kill(controller, SIGCONT);
      CHECK(tests::wait_until([&] { return bench.owner() == "length_control"; }));
    }
    safe.check();
  }
  bench.settle();
}

TEST_CASE("plant killed") {
  Bench bench;
  Row plant("plant killed", "ECU's emergency frame", 52), off("plant killed", "PWM 0", 52);
  while (off.needs_more()) {
    bench.settle();
    const pid_t pid = bench.process("plant");
    const auto from = node::wall_ns();
    kill(pid, SIGKILL);
    plant.add(from, bench.await([&] { return bench.emergency(from, ECU_FAULT_COMMAND_TIMEOUT); }));
    off.add(from, bench.await([&] { return bench.pwm_off(from); }));
  }
  plant.check(), off.check();
  bench.settle();
}

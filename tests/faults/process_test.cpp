// Processes that are killed, stopped and started again, twenty times each.
#include "tests/faults/bench.hpp"

using namespace faults;

namespace {

/// The arm, held still under length control; its safe action is to relax, so that it shows on the
/// bus.
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
  frame_command said;
  if (!frame_unpack_command(&frame, &said)) return false;
  return std::ranges::all_of(said.channel, [](const frame_channel_command& c) {
    return c.request == ECU_REQUEST_FORCE && c.setpoint == 2000;
  });
}

}  // namespace

TEST_CASE("gateway killed") {
  Row::head();
  Bench bench;
  Row said("gateway killed", "ECU's emergency frame", 52), off("gateway killed", "PWM 0", 52);
  while (off.wants()) {
    bench.settle();
    const pid_t gateway = bench.process("gateway");
    const auto from = node::wall_ns();
    kill(gateway, SIGKILL);
    said.add(from, bench.await([&] { return bench.emergency(from, ECU_FAULT_COMMAND_TIMEOUT); }));
    off.add(from, bench.await([&] { return bench.pwm_off(from); }));
  }
  said.check(), off.check();
  bench.settle();
}

TEST_CASE("gateway stopped, and no burst when it goes on") {
  Bench bench;
  Row said("gateway stopped", "ECU's emergency frame", 52), off("gateway stopped", "PWM 0", 52);
  while (off.wants()) {
    bench.settle();
    const pid_t gateway = bench.process("gateway");
    const auto from = node::wall_ns();
    kill(gateway, SIGSTOP);
    said.add(from, bench.await([&] { return bench.emergency(from, ECU_FAULT_COMMAND_TIMEOUT); }));
    off.add(from, bench.await([&] { return bench.pwm_off(from); }));
    std::this_thread::sleep_for(200ms);
    const auto again = node::wall_ns();
    kill(gateway, SIGCONT);
    std::this_thread::sleep_for(20ms);
    int burst = 0;
    for (const auto& heard : bench.bus_ear().since(again))
      burst += is_command(heard.frame) && heard.at_ns < again + 2 * ms;
    if (off.judges(again)) CHECK(burst <= 5);  // a hundred ticks have waited
  }
  said.check(), off.check();
  bench.settle();
}

TEST_CASE("ECU silent") {
  tests::Folder folder;
  write_relaxing_arm(folder);
  Bench bench(folder / "robot.xml", folder / "graph.xml");
  Row warned("ECU silent", "gateway's warning", 10 + 2),
      lost("ECU silent", "gateway: lost", 50 + 2),
      safe("ECU silent", "its limb in the safe action", 60);
  int others = 0;  // of which the same was said
  for (int k = 0; safe.wants(); ++k) {
    if (k % 6 == 0 && k > 0) std::this_thread::sleep_for(5s);  // said thrice in 10 s at most
    bench.settle();
    const int address = k % 6;
    const pid_t ecu = bench.ecu(address);
    const std::string name = "ecu " + std::to_string(address);
    const auto from = node::wall_ns();
    kill(ecu, SIGSTOP);
    warned.add(from, bench.await([&] { return bench.events().first(from, "ecu_silent", name); }));
    lost.add(from, bench.await([&] { return bench.events().first(from, "ecu_lost", name); }));
    safe.add(from, bench.await([&] {
      return bench.bus_ear().first(from, [&](const erp::CanFrame& frame) {
        frame_command said;  // to one of the others: relax
        return frame_ecu_of(&frame) == (address + 1) % 6 && frame_unpack_command(&frame, &said) &&
               said.channel[0].request == ECU_REQUEST_FORCE;
      });
    }));
    if (safe.judges(from))
      for (const auto& said : bench.events().since(from))
        others += said.code == "ecu_silent" && said.subject != name;
    kill(ecu, SIGCONT);
  }
  CHECK(others <= 1 + injections() / 4);  // a busy machine may keep one from speaking
  warned.check(), lost.check(), safe.check();
  bench.settle();
}

TEST_CASE("brown-out") {
  Bench bench;
  Row said("brown-out, reset", "boot frame with the cause", 100),
      off("brown-out, reset", "PWM 0", 2);
  while (off.wants()) {
    bench.settle();
    const pid_t ecu = bench.ecu(0);
    const auto from = node::wall_ns();
    kill(ecu, SIGKILL);
    const auto booted = bench.await([&] { return bench.boot(from, FRAME_RESET_BROWN_OUT); });
    said.add(from, booted);
    off.add(from, bench.await([&] { return bench.pwm_off(from); }));
    int armed = 0;  // in the 5 ms after its boot
    for (const auto& heard : bench.bus_ear().since(booted)) {
      frame_status status;
      armed += heard.at_ns < booted + 5 * ms && frame_unpack_status(&heard.frame, &status) &&
               status.state != ECU_STATE_BOOT;
    }
    CHECK(armed == 0);
  }
  said.check(), off.check();
  bench.settle();
}

TEST_CASE("CPU hang") {
  Bench bench;
  Row off("CPU hang", "PWM 0", 12), said("CPU hang", "boot frame with the cause", 100);
  while (off.wants()) {
    bench.settle();
    const auto from = bench.pins().befall(0, WIRE_MISHAP_HANG);
    const auto booted = bench.await([&] { return bench.boot(from, FRAME_RESET_WATCHDOG); });
    said.add(from, booted);
    off.add(from, bench.await([&] { return bench.pwm_off(from); }));
    int words = 0;  // of a program that hangs
    for (const auto& heard : bench.bus_ear().since(from))
      words +=
          heard.at_ns > from + 4 * ms && heard.at_ns < from + 20 * ms && !is_command(heard.frame);
    const bool hung_at_once = booted - from < 35 * ms;  // the watchdog's 12, and what a start takes
    if (off.judges(from) && hung_at_once) CHECK(words == 0);
  }
  off.check(), said.check();
  bench.settle();
}

TEST_CASE("controller killed, and stopped") {
  Bench bench;
  for (const int signal : {SIGKILL, SIGSTOP}) {
    const std::string fault = signal == SIGKILL ? "controller killed" : "controller stopped";
    Row safe(fault, "safe action on the bus", 22);
    while (safe.wants()) {
      bench.settle();
      const pid_t controller = bench.process("length_control");
      const auto from = node::wall_ns();
      kill(controller, signal);
      safe.add(from, bench.await([&] { return bench.bus_ear().first(from, relaxes); }));
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
  while (off.wants()) {
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

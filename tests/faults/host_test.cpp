// Faults on the host side: invalid set-points, corrupt frames, and a snapped tendon.
#include <atomic>
#include <cmath>
#include <thread>

#include "interfaces/emergency.hpp"
#include "tests/faults/bench.hpp"

using namespace faults;

namespace {

/// A controller with higher priority than the rig's own; sends a given command every 5 ms.
void send_commands(Bench& bench, double reference, int times) {
  node::Writer<erp::ActuatorCommand> commands(bench.participant());
  erp::ActuatorCommand command;
  erp::assign(command.robot, bench.robot().name);
  erp::assign(command.controller, "test_controller");
  command.priority = 50;
  erp::ActuatorReference r{};
  erp::assign(r.name, "flexor");
  r.mode = static_cast<std::uint8_t>(erp::Mode::force);
  r.reference = reference;
  erp::append(command.actuators, r);
  tests::wait_until([&] { return commands.matched() > 0; });
  for (int k = 0; k < times; ++k) {
    command.stamp_ns = node::wall_ns();
    commands.write(command);
    std::this_thread::sleep_for(5ms);
  }
}

/// Fails if the flexor's ECU has received a force command since then.
tests::Findings forces_since(Bench& bench, std::int64_t from_ns) {
  int forces = 0;
  for (const auto& received : bench.bus_recorder().since(from_ns)) {
    frame_command message;
    forces += frame_unpack_command(&received.frame, &message) &&
              message.channel[0].request == ECU_REQUEST_FORCE;
  }
  if (forces == 0) return {};
  return {std::to_string(forces) + " commands of force, which its own controller never sends"};
}

}  // namespace

TEST_CASE("set-points that are not a number or far out of range are refused with the reason") {
  Bench bench;
  for (const double reference : {std::nan(""), double{INFINITY}, 1e6, -50.0})
    tests::in_real_time([&] {  // length_control commands again if the machine does not stall
      bench.settle();
      const auto injected_ns = node::wall_ns();
      send_commands(bench, reference, 40);
      return forces_since(bench, injected_ns);
    });
  CHECK(bench.events().first(1, "reference", "flexor") != 0);
}

TEST_CASE("five consecutive corrupt commands trip, four do not; wrong lengths count as corrupt") {
  Bench bench;
  const auto corrupt = [](std::size_t count) {
    std::vector<erp::CanFrame> frames;
    for (std::size_t k = 0; k < count; ++k) {
      const frame_command message{{{3, 9000}, {3, 9000}}, 0, std::uint8_t(k & 7)};
      erp::CanFrame frame;
      frame_pack_command(&frame, 0, &message);
      if (k % 2) frame.data[3] ^= 0x10;
      else frame.size = 5;
      frames.push_back(frame);
    }
    return frames;
  };
  const auto tripped = [&](std::int64_t injected_ns) {
    return bench.wait_for([&] { return bench.emergency(injected_ns, ECU_FAULT_CORRUPT); }, 100);
  };
  for (int k = 0; k < injections(); ++k) {
    auto injected_ns = node::wall_ns();
    bench.bus_recorder().send(corrupt(4));
    CHECK(tripped(injected_ns) == 0);
  }
  ReactionTimes reaction("five consecutive corrupt frames", "ECU's emergency frame", 4);
  while (reaction.needs_more()) {
    bench.settle();
    const auto injected_ns = node::wall_ns();
    bench.bus_recorder().send(corrupt(5));
    reaction.add(injected_ns, tripped(injected_ns));
  }
  reaction.check();
}

/// Sends one reference for all actuators, as a controller of this name.
class Controller {
 public:
  Controller(Bench& bench, const std::string& name, std::int32_t priority)
      : commands_(bench.participant()) {
    erp::assign(command_.robot, bench.robot().name);
    erp::assign(command_.controller, name);
    command_.priority = priority;
    for (const auto& actuator : bench.robot().actuators) {
      erp::ActuatorReference reference{};
      erp::assign(reference.name, actuator.name);
      erp::append(command_.actuators, reference);
    }
    tests::wait_until([&] { return commands_.matched() > 0; });
  }
  void send(std::uint8_t mode, double reference) {
    command_.stamp_ns = node::wall_ns();
    for (auto& r : erp::samples(command_.actuators)) r.mode = mode, r.reference = reference;
    commands_.write(command_);
  }

 private:
  node::Writer<erp::ActuatorCommand> commands_;
  erp::ActuatorCommand command_;
};

TEST_CASE("one emergency off wins against eight controllers that fill the table of the plant") {
  Bench bench;
  std::vector<std::unique_ptr<Controller>> weak;
  for (int k = 0; k < 8; ++k)
    weak.push_back(std::make_unique<Controller>(bench, "weak_" + std::to_string(k), -10));
  Controller emergency(bench, "hand", erp::emergency_priority);
  std::atomic<bool> is_ending = false;
  std::thread sender([&] {
    while (!is_ending) {
      for (auto& controller : weak) controller->send(std::uint8_t(erp::Mode::force), 3);
      std::this_thread::sleep_for(2ms);
    }
  });
  ReactionTimes off("eight weak controllers, emergency off", "PWM 0", 22);
  while (off.needs_more()) {
    bench.settle();
    const auto injected_ns = node::wall_ns();
    emergency.send(std::uint8_t(erp::Mode::off), 0);  // once: the plant latches it
    off.add(injected_ns, bench.wait_for([&] { return bench.pwm_off(injected_ns); }, 1000));
    emergency.send(erp::release_mode, 0);
  }
  is_ending = true;
  sender.join();
  off.check();
}

/// The rig with 20 N on both tendons; the flexor's tendon snaps after 4 s.
void write_rig_with_snapping_tendon(const tests::Folder& folder) {
  write_rig(folder);
  std::ofstream(folder / "sim.xml")
      << "<sim><fault kind=\"tendon_snaps\" on=\"flexor\" at_s=\"4\"/></sim>\n";
  std::ofstream(folder / "force.csv") << "time_s,flexor.mode,flexor.reference,extensor.mode,"
                                         "extensor.reference\n0,force,20,force,20\n60,force,20,"
                                         "force,20\n";
  std::ofstream(folder / "target.xml") << "<target file=\"force.csv\"/>\n";
  std::ofstream(folder / "force_control.xml") << "<force_control where=\"ecu\"/>\n";
  std::ofstream(folder / "graph.xml")
      << "<graph name=\"rig\" robot=\"robot.xml\" device=\"can\">\n"
         "  <component name=\"sim\" config=\"sim.xml\"/>\n"
         "  <component name=\"target\" config=\"target.xml\"/>\n"
         "  <component name=\"force_control\" config=\"force_control.xml\"/>\n"
         "</graph>\n";
}

TEST_CASE("after a tendon snaps its actuator is switched off") {
  tests::Folder folder;
  write_rig_with_snapping_tendon(folder);
  ReactionTimes slack("tendon snapped", "detected by the plant", 22);
  while (slack.needs_more(1 + injections() / 5)) {
    Bench bench(folder / "robot.xml", folder / "graph.xml");
    const auto snapped_ns =
        bench.wait_for([&] { return bench.events().first(1, "fault_injected", "flexor"); }, 8000);
    REQUIRE(snapped_ns != 0);
    slack.add(snapped_ns,
              bench.wait_for([&] { return bench.events().first(snapped_ns, "tendon_slack"); }));
    CHECK(bench.wait_for([&] { return bench.events().first(snapped_ns, "tendon_snapped"); },
                         8000) != 0);
    CHECK(bench.wait_for([&] { return bench.pwm_off(snapped_ns, 0, 0); }) != 0);
  }
  slack.check();
}

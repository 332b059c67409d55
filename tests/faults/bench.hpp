#pragma once
#include <fstream>
#include <memory>

#include "hal/can/robot_buses.hpp"
#include "interfaces/robot/robot.hpp"
#include "tests/faults/pin_relay.hpp"
#include "tests/faults/reaction_times.hpp"
#include "tests/faults/recorders.hpp"
#include "tests/system/background.hpp"

/// A running robot for fault injection: the graph, its ECUs as separate programs, a relay on their
/// pins, a recorder on the CAN bus and one on the events.
namespace faults {

using namespace std::chrono_literals;
inline constexpr std::int64_t ms = 1'000'000;

/// The hinge rig under length control, moving back and forth by the given amount, with the sensors
/// needed to detect every fault: potentiometers, force sensors with a live zero, temperature by
/// gains that a test sets.
inline void write_rig(const tests::Folder& folder, double amplitude_m = 0) {
  std::string robot = tests::content(ERP_SOURCE_DIR "/configs/hinge_rig/robot.xml");
  const auto put = [&](const std::string& position, const std::string& text) {
    robot.insert(robot.find(position), text);
  };
  const auto replace = [&](const std::string& old_text, const std::string& new_text) {
    robot.replace(robot.find(old_text), old_text.size(), new_text);
  };
  replace("tension_noise_N=\"0.05\"", "tension_noise_N=\"0.1\" tension_zero_counts=\"200\"");
  for (const auto& [actuator, input] : {std::pair{"flexor", "1"}, {"extensor", "2"}})
    put("</robot>", std::string("<potentiometer actuator=\"") + actuator + "\" ecu=\"0\" input=\"" +
                        input + "\" bits=\"12\" range_rad=\"20\" start_rad=\"10\"/>\n");
  std::ofstream(folder / "robot.xml") << robot;
  std::ofstream lengths(folder / "lengths.csv");
  lengths << "time_s,flexor.mode,flexor.reference,extensor.mode,extensor.reference\n";
  for (int k = 0; k <= 100; ++k) {  // a triangle with a period of 2 s: 16 mm/s at 8 mm
    const double phase = k / 100.0, up = phase < 0.25   ? phase
                                         : phase < 0.75 ? 0.5 - phase
                                                        : phase - 1;
    const double line_m = amplitude_m * 4 * up;
    lengths << 2 * phase << ",length," << -0.004 - line_m << ",length," << -0.004 + line_m << '\n';
  }
  lengths.close();
  std::ofstream(folder / "target.xml") << "<target file=\"lengths.csv\" loop=\"true\"/>\n";
  std::ofstream(folder / "length_control.xml") << "<length_control where=\"ecu\"/>\n";
  std::ofstream(folder / "graph.xml")
      << "<graph name=\"rig\" robot=\"robot.xml\" device=\"can\">\n"
         "  <component name=\"target\" config=\"target.xml\"/>\n"
         "  <component name=\"length_control\" config=\"length_control.xml\" restart=\"always\"/>\n"
         "</graph>\n";
}

class Bench {
 public:
  /// `robot` and `graph`: files; default: the rig above. `host_bus`: the gateway's bus, if
  /// different from the ECUs'.
  explicit Bench(const std::string& robot = "", const std::string& graph = "",
                 std::vector<std::string> options = {}, const std::string& host_bus = bus())
      : robot_file_(robot.empty() ? folder_ / "robot.xml" : robot) {
    if (robot.empty()) write_rig(folder_);
    robot_ = erp::read_robot(robot_file_);
    rack_ = std::make_unique<tests::Background>(
        std::vector<std::string>{"--robot", robot_file_, "--bus", bus(), "--converters",
                                 "127.0.0.1:" + std::to_string(relay_port)},
        folder_ / "ecu.txt", "ecu");
    relay_ = std::make_unique<PinRelay>(relay_port, robot_port);
    bus_recorder_ =
        std::make_unique<BusRecorder>(erp::bus_specifications(bus(), robot_.buses().size()));
    std::vector<std::string> arguments{
        "launch",     graph.empty() ? folder_ / "graph.xml" : graph,
        "--device",   "can",
        "--restarts", "100",
        "--out",      folder_ / "run",
        "--set",      "gateway.bus=" + host_bus,
        "--set",      "sim.bus=" + bus(),
        "--set",      "sim.converter_port=" + std::to_string(robot_port)};
    arguments.insert(arguments.end(), options.begin(), options.end());
    graph_ = std::make_unique<tests::Background>(arguments, folder_ / "graph.txt");
    REQUIRE(graph_->wait_for_output("all components are active"));
    settle();
  }
  ~Bench() {
    graph_->stop();
    rack_->stop(SIGTERM);
  }

  /// The ECUs' bus, and the bus of a gateway on the other side of a cable.
  static std::string bus() { return "udp:239.255.42.9:" + std::to_string(26000 + 16 * own_domain); }
  static std::string host_bus_behind_cable() {
    return "udp:239.255.42.10:" + std::to_string(26000 + 16 * own_domain);
  }
  const erp::Robot& robot() const { return robot_; }
  PinRelay& pins() { return *relay_; }
  BusRecorder& bus_recorder() { return *bus_recorder_; }
  EventRecorder& events() { return events_; }
  tests::Background& graph() { return *graph_; }
  tests::Background& rack() { return *rack_; }
  const node::Entity& participant() const { return participant_; }

  /// Process id of the graph's component with this program name.
  pid_t process(const std::string& program) {
    pid_t pid = 0;
    REQUIRE(tests::wait_until([&] { return (pid = graph_->child(program)) > 0; }));
    return pid;
  }
  /// The process that runs an ECU's firmware.
  pid_t ecu(int address) {
    const std::string message = rack_->output(),
                      prefix = "ecu " + std::to_string(address) + ": process ";
    return std::stoi(message.substr(message.rfind(prefix) + prefix.size()));
  }
  /// Waits until every channel has run for 300 ms; false after 5 s.
  bool wait_until_running() {
    const auto deadline_ns = node::monotonic_ns() + 5000 * ms;
    bool all_running = false;
    tests::wait_until(
        [&] { return (all_running = all_run()) || node::monotonic_ns() > deadline_ns; });
    return all_running;
  }
  /// Prepares a new injection: waits until all channels run and clears the recorders. Faults that
  /// remain latched are cleared by an operator command and printed. Returns their number.
  int settle() {
    pins().pass_unchanged();
    int attempts = 0;
    for (; !wait_until_running(); ++attempts) {
      if (attempts == 3)
        FAIL("the graph does not recover:\n" << graph_->output() << rack_->output());
      std::printf("  (fault without injection, cleared: %s)\n", last_fault().c_str());
      command_off();
    }
    pins().clear();
    bus_recorder_->clear();
    return attempts;
  }
  std::string last_fault() {
    std::string text = "no fault reported";
    for (const auto& message : events_.since(1))
      if (message.code == "ecu_fault") text = message.subject + ", " + message.text;
    return text;
  }
  /// Waits until `find()` returns a time; 0 after a timeout.
  template <class Find>
  std::int64_t wait_for(Find find, int for_ms = 3000) {
    for (int k = 0; k < for_ms; ++k) {
      if (const std::int64_t at = find()) return at;
      std::this_thread::sleep_for(1ms);
    }
    return 0;
  }
  /// Time from which both PWM outputs of an ECU stay at 0 after `from_ns`; 0: they do not.
  std::int64_t pwm_off(std::int64_t from_ns, int ecu = 0, int channel = -1) {
    std::int64_t since = 0;
    for (const auto& drive : pins().drives_since(from_ns)) {
      if (drive.ecu != ecu) continue;
      const bool off = channel >= 0 ? drive.duty[std::size_t(channel)] == 0
                                    : drive.duty[0] == 0 && drive.duty[1] == 0;
      if (!off) since = 0;
      else if (since == 0) since = drive.at_ns;
    }
    return since;
  }
  /// Time at which an ECU's next period set its pins; 0: not yet.
  std::int64_t next_period(std::int64_t from_ns, int ecu = 0) {
    for (const auto& drive : pins().drives_since(from_ns))
      if (drive.ecu == ecu) return drive.at_ns;
    return 0;
  }
  /// Time at which an ECU first reported the fault.
  std::int64_t emergency(std::int64_t from_ns, int fault) {
    return bus_recorder_->first(from_ns, [&](const erp::CanFrame& frame) {
      frame_emergency message;
      return frame_unpack_emergency(&frame, &message) && !message.boot && message.fault == fault;
    });
  }
  /// Time at which an ECU first reported a boot with that cause.
  std::int64_t boot(std::int64_t from_ns, int cause) {
    return bus_recorder_->first(from_ns, [&](const erp::CanFrame& frame) {
      frame_emergency message;
      return frame_unpack_emergency(&frame, &message) && message.boot &&
             message.reset_cause == cause;
    });
  }
  /// The controller of the first actuator, as the plant publishes it (ten times a second).
  std::string owner() {
    node::Reader<erp::ActuatorOwner> owners(participant_, wake_);
    std::string owner = "?";
    tests::wait_until([&] {
      owners.take([&](const erp::ActuatorOwner& m) { owner = m.actuators._buffer[0].owner; });
      return owner != "?";
    });
    return owner;
  }
  /// Clears latched faults: commands mode off for 250 ms, as an operator would.
  void command_off();

 private:
  /// True if every channel has been running for 300 ms and has sent at the beginning and end of
  /// that time.
  bool all_run() {
    const auto end_ns = node::wall_ns(), begin_ns = end_ns - 300 * ms;
    std::map<std::uint16_t, bool> ran_at_start, ran_at_end;
    for (const auto& received : bus_recorder_->since(begin_ns)) {
      frame_status message;
      if (!frame_unpack_status(&received.frame, &message)) continue;
      if (message.state != ECU_STATE_RUNNING) return false;
      ran_at_start[received.frame.id] |= received.at_ns < begin_ns + 50 * ms;
      ran_at_end[received.frame.id] = received.at_ns > end_ns - 50 * ms;
    }
    const auto is_true = [](const auto& channel) { return channel.second; };
    return ran_at_start.size() == robot_.actuators.size() &&
           std::ranges::all_of(ran_at_start, is_true) && std::ranges::all_of(ran_at_end, is_true);
  }

  static inline const int relay_port = 31000 + 2 * own_domain, robot_port = relay_port + 1;

  tests::Folder folder_;
  std::string robot_file_;
  erp::Robot robot_;
  node::Entity participant_ = node::join("hand");
  node::Wake wake_;
  EventRecorder events_{participant_};
  std::unique_ptr<tests::Background> rack_, graph_;
  std::unique_ptr<PinRelay> relay_;
  std::unique_ptr<BusRecorder> bus_recorder_;
};

/// Command of an operator: all actuators off, at a higher priority than the controller.
inline void Bench::command_off() {
  node::Writer<erp::ActuatorCommand> commands(participant_);
  erp::ActuatorCommand command;
  erp::assign(command.robot, robot_.name);
  erp::assign(command.controller, "hand");
  command.priority = 100;
  for (const auto& actuator : robot_.actuators) {
    erp::ActuatorReference reference{};
    erp::assign(reference.name, actuator.name);
    reference.mode = static_cast<std::uint8_t>(erp::Mode::off);
    erp::append(command.actuators, reference);
  }
  tests::wait_until([&] { return commands.matched() > 0; });
  for (int k = 0; k < 50; ++k) {
    command.stamp_ns = node::wall_ns();
    commands.write(command);
    std::this_thread::sleep_for(5ms);
  }
}

}  // namespace faults

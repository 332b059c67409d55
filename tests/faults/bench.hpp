#pragma once
#include <fstream>
#include <memory>

#include "hal/can/robot_buses.hpp"
#include "interfaces/robot/robot.hpp"
#include "tests/faults/ears.hpp"
#include "tests/faults/pin_relay.hpp"
#include "tests/faults/row.hpp"
#include "tests/system/background.hpp"

/// A running robot to do harm to: the graph, its ECUs as programs of their own, a hand on their
/// pins, an ear on the CAN bus and one on the events.
namespace faults {

using namespace std::chrono_literals;
inline constexpr std::int64_t ms = 1'000'000;

/// The hinge rig under length control, moving to and fro by so much, with what it lacks to tell
/// every fault: potentiometers, a live zero of its force sensors, temperature by gains that a test
/// sets.
inline void write_rig(const tests::Folder& folder, double amplitude_m = 0) {
  std::string robot = tests::content(ERP_SOURCE_DIR "/configs/hinge_rig/robot.xml");
  const auto put = [&](const std::string& before, const std::string& text) {
    robot.insert(robot.find(before), text);
  };
  const auto change = [&](const std::string& from, const std::string& to) {
    robot.replace(robot.find(from), from.size(), to);
  };
  change("tension_noise_N=\"0.05\"", "tension_noise_N=\"0.1\" tension_zero_counts=\"200\"");
  for (const auto& [actuator, input] : {std::pair{"flexor", "1"}, {"extensor", "2"}})
    put("</robot>", std::string("<potentiometer actuator=\"") + actuator + "\" ecu=\"0\" input=\"" +
                        input + "\" bits=\"12\" range_rad=\"20\" start_rad=\"10\"/>\n");
  std::ofstream(folder / "robot.xml") << robot;
  std::ofstream lengths(folder / "lengths.csv");
  lengths << "time_s,flexor.mode,flexor.reference,extensor.mode,extensor.reference\n";
  for (int k = 0; k <= 100; ++k) {  // a triangle of two seconds: at 8 mm 16 mm/s
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
  /// `robot` and `graph`: files; without them the rig above. `host_bus`: the gateway's, if it is
  /// not the ECUs'.
  explicit Bench(const std::string& robot = "", const std::string& graph = "",
                 std::vector<std::string> more = {}, const std::string& host_bus = bus())
      : robot_file_(robot.empty() ? folder_ / "robot.xml" : robot) {
    if (robot.empty()) write_rig(folder_);
    robot_ = erp::read_robot(robot_file_);
    rack_ = std::make_unique<tests::Background>(
        std::vector<std::string>{"--robot", robot_file_, "--bus", bus(), "--converters",
                                 "127.0.0.1:" + std::to_string(relay_port)},
        folder_ / "ecu.txt", "ecu");
    relay_ = std::make_unique<PinRelay>(relay_port, robot_port);
    ear_ = std::make_unique<BusEar>(erp::bus_words(bus(), robot_.buses().size()));
    std::vector<std::string> words{
        "launch",     graph.empty() ? folder_ / "graph.xml" : graph,
        "--device",   "can",
        "--restarts", "100",
        "--out",      folder_ / "run",
        "--set",      "gateway.bus=" + host_bus,
        "--set",      "sim.bus=" + bus(),
        "--set",      "sim.converter_port=" + std::to_string(robot_port)};
    words.insert(words.end(), more.begin(), more.end());
    graph_ = std::make_unique<tests::Background>(words, folder_ / "graph.txt");
    REQUIRE(graph_->says("all components are active"));
    settle();
  }
  ~Bench() {
    graph_->stop();
    rack_->stop(SIGTERM);
  }

  /// The ECUs' bus, and one for a gateway at the other end of a cable.
  static std::string bus() { return "udp:239.255.42.9:" + std::to_string(26000 + 16 * own_domain); }
  static std::string far_bus() {
    return "udp:239.255.42.10:" + std::to_string(26000 + 16 * own_domain);
  }
  const erp::Robot& robot() const { return robot_; }
  PinRelay& pins() { return *relay_; }
  BusEar& bus_ear() { return *ear_; }
  EventEar& events() { return events_; }
  tests::Background& graph() { return *graph_; }
  tests::Background& rack() { return *rack_; }
  const node::Entity& participant() const { return participant_; }

  /// Kills or stops the graph's process of that name. Returns its id.
  pid_t process(const std::string& program) {
    pid_t pid = 0;
    REQUIRE(tests::wait_until([&] { return (pid = graph_->child(program)) > 0; }));
    return pid;
  }
  /// The process that runs an ECU's firmware.
  pid_t ecu(int address) {
    const std::string said = rack_->output(),
                      words = "ecu " + std::to_string(address) + ": process ";
    return std::stoi(said.substr(said.rfind(words) + words.size()));
  }
  /// Waits until every channel has run for 300 ms.
  bool recovers() {
    const auto patience = node::monotonic_ns() + 5000 * ms;
    bool well = false;
    tests::wait_until([&] { return (well = all_run()) || node::monotonic_ns() > patience; });
    return well;
  }
  /// Begins a new injection: all is well, and what was heard so far is forgotten. What latched, and
  /// was not the last injection's, is cleared by a person's word and told. Returns how often.
  int settle() {
    pins().leave_alone();
    int tries = 0;
    for (; !recovers(); ++tries) {
      if (tries == 3)
        FAIL("the graph does not come back:\n" << graph_->output() << rack_->output());
      std::printf("  (cleared by hand: %s)\n", last_fault().c_str());
      say_off();
    }
    pins().forget();
    ear_->forget();
    return tries;
  }
  std::string last_fault() {
    std::string text = "no fault said";
    for (const auto& said : events_.since(1))
      if (said.code == "ecu_fault") text = said.subject + ", " + said.text;
    return text;
  }
  /// Waits for `find()` to give a time; 0 after a while.
  template <class Find>
  std::int64_t await(Find find, int for_ms = 3000) {
    for (int k = 0; k < for_ms; ++k) {
      if (const std::int64_t at = find()) return at;
      std::this_thread::sleep_for(1ms);
    }
    return 0;
  }
  /// When both PWM outputs of an ECU have come to rest at 0 after `from_ns`; 0: they have not.
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
  /// When an ECU's next period drove its pins; 0: it has not yet.
  std::int64_t next_period(std::int64_t from_ns, int ecu = 0) {
    for (const auto& drive : pins().drives_since(from_ns))
      if (drive.ecu == ecu) return drive.at_ns;
    return 0;
  }
  /// When an ECU first said that fault.
  std::int64_t emergency(std::int64_t from_ns, int fault) {
    return ear_->first(from_ns, [&](const erp::CanFrame& frame) {
      frame_emergency said;
      return frame_unpack_emergency(&frame, &said) && !said.boot && said.fault == fault;
    });
  }
  /// When an ECU first said that it booted, for that reason.
  std::int64_t boot(std::int64_t from_ns, int cause) {
    return ear_->first(from_ns, [&](const erp::CanFrame& frame) {
      frame_emergency said;
      return frame_unpack_emergency(&frame, &said) && said.boot && said.reset_cause == cause;
    });
  }
  /// Who drives the first actuator, as the plant publishes it (ten times a second).
  std::string owner() {
    node::Reader<erp::ActuatorOwner> owners(participant_, wake_);
    std::string found = "?";
    tests::wait_until([&] {
      owners.take([&](const erp::ActuatorOwner& m) { found = m.actuators._buffer[0].owner; });
      return found != "?";
    });
    return found;
  }
  /// Clears what latches: the driver says off for a while, as a person would.
  void say_off();

 private:
  /// Whether every channel runs, has done so for 300 ms, and speaks at both ends of that time.
  bool all_run() {
    const auto to = node::wall_ns(), from = to - 300 * ms;
    std::map<std::uint16_t, bool> ran_long, speaks;
    for (const auto& heard : ear_->since(from)) {
      frame_status said;
      if (!frame_unpack_status(&heard.frame, &said)) continue;
      if (said.state != ECU_STATE_RUNNING) return false;
      ran_long[heard.frame.id] |= heard.at_ns < from + 50 * ms;
      speaks[heard.frame.id] = heard.at_ns > to - 50 * ms;
    }
    const auto yes = [](const auto& channel) { return channel.second; };
    return ran_long.size() == robot_.actuators.size() && std::ranges::all_of(ran_long, yes) &&
           std::ranges::all_of(speaks, yes);
  }

  static inline const int relay_port = 31000 + 2 * own_domain, robot_port = relay_port + 1;

  tests::Folder folder_;
  std::string robot_file_;
  erp::Robot robot_;
  node::Entity participant_ = node::join("hand");
  node::Wake wake_;
  EventEar events_{participant_};
  std::unique_ptr<tests::Background> rack_, graph_;
  std::unique_ptr<PinRelay> relay_;
  std::unique_ptr<BusEar> ear_;
};

/// A person's word over a controller's: all actuators off, at a higher priority.
inline void Bench::say_off() {
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

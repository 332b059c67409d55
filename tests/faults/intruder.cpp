// An unauthorised participant: commands mode off to every actuator at the highest priority, and
// receives sensor frames.
//   intruder ROBOT.xml SECONDS [NAME]
// With a NAME it claims to be the component of that name, to have joined first and to be active.
// Prints the largest numbers of matched readers and writers, the number of received frames, and the
// time until both were matched.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <string>
#include <thread>

#include "components/node/bus.hpp"
#include "components/node/clock.hpp"
#include "interfaces/robot/robot.hpp"
#include "interfaces/values.hpp"

namespace {

constexpr std::int64_t second_ns = 1'000'000'000;
constexpr int highest_priority = 100;

node::Peer impostor(const std::string& name, const std::string& robot) {
  node::Peer peer = node::own_peer(name.empty() ? "intruder" : name, name.empty() ? "" : robot);
  if (!name.empty()) peer.joined_ns = 1, peer.active = true;
  return peer;
}

erp::ActuatorCommand all_off(const erp::Robot& robot) {
  erp::ActuatorCommand command;
  erp::assign(command.robot, robot.name);
  erp::assign(command.controller, "intruder");
  command.priority = highest_priority;
  for (const auto& actuator : robot.actuators) {
    erp::ActuatorReference reference{};
    erp::assign(reference.name, actuator.name);
    reference.mode = static_cast<std::uint8_t>(erp::Mode::off);
    erp::append(command.actuators, reference);
  }
  return command;
}

void intrude(const erp::Robot& robot, double for_s, const std::string& name) {
  const node::Entity participant = node::join(impostor(name, robot.name));
  node::Wake wake;
  node::Writer<erp::ActuatorCommand> commands(participant);
  node::Reader<erp::SensorFrame> frames(participant, wake, 16);
  erp::ActuatorCommand command = all_off(robot);
  std::uint32_t readers = 0, writers = 0, received = 0;
  const auto from_ns = node::monotonic_ns();
  std::int64_t matched_ns = 0;
  while (node::monotonic_ns() - from_ns < static_cast<std::int64_t>(for_s * second_ns)) {
    command.stamp_ns = node::wall_ns();
    commands.write(command);
    frames.take([&](const erp::SensorFrame&) { ++received; });
    readers = std::max(readers, commands.matched());
    writers = std::max(writers, frames.matched());
    if (readers && writers && !matched_ns) matched_ns = node::monotonic_ns() - from_ns;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  std::printf("readers %u writers %u received %u after_ms %.0f\n", readers, writers, received,
              1e-6 * static_cast<double>(matched_ns));
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 3) return 2;
  intrude(erp::read_robot(argv[1]), std::stod(argv[2]), argc > 3 ? argv[3] : "");
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "intruder: %s\n", error.what());
  return 1;
}

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <ostream>
#include <stdexcept>

#include "components/node/clock.hpp"
#include "interfaces/values.hpp"
#include "interfaces/xml/words.hpp"
#include "launch/erp/command/command.hpp"
#include "launch/erp/command/robot_link.hpp"

namespace launch {
namespace {

constexpr std::int64_t print_period_ns = 500'000'000;        // chosen
constexpr std::int64_t obstacle_timeout_ns = 1'000'000'000;  // chosen: 10 reports of the owners
constexpr std::int64_t forever_ns = std::int64_t{1} << 62;

erp::Mode mode_of(const std::string& name) {
  std::vector<std::string> names;
  for (const auto mode : {erp::Mode::off, erp::Mode::voltage, erp::Mode::length, erp::Mode::current,
                          erp::Mode::force}) {
    if (name == erp::name_of(mode)) return mode;
    names.emplace_back(erp::name_of(mode));
  }
  throw std::invalid_argument("unknown mode \"" + name + "\"; " + xml::did_you_mean(name, names));
}

double measured(const erp::ActuatorSample& sample, erp::Mode mode) {
  switch (mode) {
    case erp::Mode::voltage:
      return sample.voltage_V;
    case erp::Mode::length:
      return sample.line_m;
    case erp::Mode::current:
      return sample.current_A;
    case erp::Mode::force:
    case erp::Mode::off:
      break;
  }
  return sample.tension_N;
}

void check_actuators(const RobotLink::Robot& robot, const std::vector<std::string>& actuators) {
  for (const auto& actuator : actuators)
    if (!robot.has_actuator(actuator))
      throw std::invalid_argument("the robot has no actuator \"" + actuator + "\"; " +
                                  xml::did_you_mean(actuator, actuators_of(robot)));
}

/// Why an actuator does not follow; empty: it does.
std::string obstacle(const RobotLink::Robot& robot, const std::string& actuator,
                     const std::string& controller, erp::Mode mode) {
  const auto* owner = robot.owner(actuator);
  const auto* sample = robot.sample(actuator);
  if (!owner || !sample) return "";
  if (owner->priority == erp::emergency_priority)
    return fmt::format("{}: {} keeps it off; release it with: erp stop --release", actuator,
                       owner->owner);
  if (owner->owner[0] && controller != owner->owner)
    return fmt::format("{} is driven by {} with priority {}; raise --priority", actuator,
                       owner->owner, owner->priority);
  if (mode != erp::Mode::off &&
      sample->ecu_state == static_cast<std::uint8_t>(erp::EcuState::fault))
    return fmt::format("{0}: its ECU has switched off with fault {1}; erp send {0} off clears it",
                       actuator, sample->ecu_fault);
  if (owner->owner[0]) return "";
  return fmt::format("{}: the plant does not follow the command; {}", actuator,
                     owner->reason[0] ? owner->reason : "it has no owner");
}

std::string first_obstacle(const RobotLink::Robot& robot, const SendOptions& options,
                           const std::string& controller, erp::Mode mode) {
  for (const auto& actuator : options.actuators)
    if (auto found = obstacle(robot, actuator, controller, mode); !found.empty()) return found;
  return "";
}

void print_measured(const RobotLink::Robot& robot, const SendOptions& options, erp::Mode mode,
                    std::ostream& out) {
  const std::string unit = mode == erp::Mode::off ? "N" : erp::unit_of(mode);
  const std::string commanded =
      mode == erp::Mode::off ? "off"
                             : fmt::format("{} {:.4g} {}", options.mode, options.reference, unit);
  for (const auto& actuator : options.actuators)
    if (const auto* sample = robot.sample(actuator))
      out << fmt::format("{}: {}, measured {:.4g} {}\n", actuator, commanded,
                         measured(*sample, mode), unit);
  out << std::flush;
}

/// Commands until the end or an obstacle that lasts; returns that obstacle.
std::string drive(RobotLink& link, const std::string& name, const SendOptions& options,
                  erp::Mode mode, std::ostream& out) {
  const RobotLink::Robot& robot = link.robot(name);
  std::int64_t followed_ns = node::monotonic_ns(), printed_ns = followed_ns;
  std::string obstacle;
  const bool is_limited = options.for_s > 0 && options.for_s < 1e-9 * double(forever_ns);
  link.watch(is_limited ? static_cast<std::int64_t>(1e9 * options.for_s) : forever_ns, [&] {
    link.command(name, options.actuators, static_cast<std::uint8_t>(mode), options.reference,
                 options.priority);
    const std::int64_t now_ns = node::monotonic_ns();
    obstacle = first_obstacle(robot, options, link.controller(), mode);
    if (obstacle.empty()) followed_ns = now_ns;
    if (now_ns - printed_ns >= print_period_ns) {
      printed_ns = now_ns;
      print_measured(robot, options, mode, out);
    }
    return now_ns - followed_ns > obstacle_timeout_ns;
  });
  return node::monotonic_ns() - followed_ns > obstacle_timeout_ns ? obstacle : "";
}

}  // namespace

int send_command(const SendOptions& options, std::ostream& out) {
  const erp::Mode mode = mode_of(options.mode);
  RobotLink link("send", "erp_send_" + std::to_string(getpid()));
  link.find_robots();
  const std::string name = link.choose(options.robot);
  check_actuators(link.robot(name), options.actuators);
  const std::string obstacle = drive(link, name, options, mode, out);
  link.command(name, options.actuators, erp::release_mode, 0, options.priority);
  link.watch(print_period_ns / 10, [] { return false; });  // until the release has been delivered
  if (!obstacle.empty()) throw std::runtime_error(obstacle);
  out << "released\n";
  return 0;
}

}  // namespace launch

#include <fmt/format.h>

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

constexpr std::int64_t print_period_ns = 500'000'000;     // chosen
constexpr std::int64_t owner_timeout_ns = 1'000'000'000;  // chosen: 10 reports of the owners
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

/// Who keeps an actuator from this verb; empty: nobody.
std::string refusal(const RobotLink::Robot& robot, const std::vector<std::string>& actuators,
                    const std::string& controller) {
  for (const auto& actuator : actuators) {
    const auto* owner = robot.owner(actuator);
    if (!owner || controller == owner->owner) continue;
    if (owner->priority == erp::emergency_priority)
      return fmt::format("{}: {} keeps it off; release it with: erp stop --release", actuator,
                         owner->owner);
    if (owner->owner[0])
      return fmt::format("{} is driven by {} with priority {}; raise --priority", actuator,
                         owner->owner, owner->priority);
    return fmt::format("{}: the plant refuses the command: {}", actuator, owner->reason);
  }
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

}  // namespace

int send_command(const SendOptions& options, std::ostream& out) {
  const erp::Mode mode = mode_of(options.mode);
  RobotLink link("send", hand_controller);
  link.find_robots();
  const std::string name = link.choose(options.robot);
  RobotLink::Robot& robot = link.robot(name);
  check_actuators(robot, options.actuators);
  const std::int64_t start_ns = node::monotonic_ns();
  std::int64_t printed_ns = start_ns;
  std::string refused;
  link.watch(options.for_s > 0 ? static_cast<std::int64_t>(1e9 * options.for_s) : forever_ns, [&] {
    link.command(name, options.actuators, static_cast<std::uint8_t>(mode), options.reference,
                 options.priority);
    const std::int64_t now_ns = node::monotonic_ns();
    if (now_ns - start_ns > owner_timeout_ns)
      refused = refusal(robot, options.actuators, link.controller());
    if (now_ns - printed_ns < print_period_ns) return !refused.empty();
    printed_ns = now_ns;
    print_measured(robot, options, mode, out);
    return !refused.empty();
  });
  link.command(name, options.actuators, erp::release_mode, 0, options.priority);
  link.watch(print_period_ns / 10, [] { return false; });  // until the release has been delivered
  if (!refused.empty()) throw std::runtime_error(refused);
  out << "released\n";
  return 0;
}

}  // namespace launch

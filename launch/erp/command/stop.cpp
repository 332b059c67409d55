#include <algorithm>
#include <ostream>
#include <set>

#include "interfaces/values.hpp"
#include "launch/erp/command/command.hpp"
#include "launch/erp/command/robot_link.hpp"

namespace launch {
namespace {

constexpr std::int64_t confirm_timeout_ns = 2'000'000'000;  // chosen: 20 reports of the owners

/// Whether the owner of every actuator has the emergency priority, or of none.
bool is_confirmed(const RobotLink::Robot& robot, bool latched) {
  if (!robot.owners) return false;
  return std::ranges::all_of(erp::samples(robot.owners->actuators), [&](const auto& actuator) {
    return (actuator.priority == erp::emergency_priority) == latched;
  });
}

/// Commands every robot until its plant confirms it. Returns the robots that did not.
std::set<std::string> command_all(RobotLink& link, const StopOptions& options) {
  std::set<std::string> open;
  for (const auto& [name, robot] : link.robots())
    if (options.robot.empty() || name == options.robot) open.insert(name);
  const auto mode = options.release ? erp::release_mode : static_cast<std::uint8_t>(erp::Mode::off);
  link.watch(confirm_timeout_ns, [&] {
    for (const auto& name : open)
      link.command(name, actuators_of(link.robot(name)), mode, 0, erp::emergency_priority);
    std::erase_if(open, [&](const std::string& name) {
      return is_confirmed(link.robot(name), !options.release);
    });
    return open.empty();
  });
  return open;
}

}  // namespace

int stop_robots(const StopOptions& options, std::ostream& out) {
  RobotLink link("stop", "erp_stop");
  link.find_robots();
  if (!options.robot.empty() && !link.silent_robots().contains(options.robot))
    link.choose(options.robot);
  const auto unconfirmed = command_all(link, options);
  for (auto& [name, robot] : link.robots()) {
    if (!options.robot.empty() && name != options.robot) continue;
    const auto count = std::to_string(robot.frame.actuators._length);
    if (unconfirmed.contains(name))
      out << name << ": its plant did not confirm within 2 s; switch the power off\n";
    else if (options.release) out << name << ": " << count << " actuators released\n";
    else
      out << name << ": the plant keeps " << count
          << " actuators off; release them with: erp stop --release\n";
  }
  for (const auto& name : link.silent_robots())
    if (options.robot.empty() || name == options.robot)
      out << name << ": not commanded, because its device sends no frames; switch the power off\n";
  return unconfirmed.empty() && link.silent_robots().empty() ? 0 : 1;
}

}  // namespace launch

#include <unistd.h>

#include <ostream>
#include <stdexcept>

#include "interfaces/xml/words.hpp"
#include "launch/erp/command/command.hpp"
#include "launch/erp/command/robot_link.hpp"

namespace launch {
namespace {

constexpr std::int64_t answer_timeout_ns =
    3'000'000'000;  // chosen: the plant waits 1 s for the ECU

/// Counts that change when gains or, of `refused_by_plant`, references are accepted or refused.
struct Counts {
  int accepted = 0, refused_by_ecu = 0;
  unsigned refused_by_plant = 0;
};

Counts counts_of(const RobotLink::Robot& robot, const std::string& actuator) {
  const auto* channel = robot.channel(actuator);
  const auto* owner = robot.owner(actuator);
  return {channel ? channel->gain_sets_accepted : 0, channel ? channel->gain_sets_refused : 0,
          owner ? owner->refused : 0};
}

/// The reason of the last refusal if it concerns these gains; empty: it concerns another command.
std::string reason_for(const SetOptions& options, const erp::ActuatorOwnerSample& owner) {
  const std::string reason = owner.reason;
  bool concerns_gains = reason.find("refused gains") != reason.npos;
  for (const auto& [parameter, value] : options.gains)
    concerns_gains = concerns_gains || reason.find(parameter) != reason.npos;
  return concerns_gains ? reason : "";
}

erp::GainCommand message_of(const SetOptions& options) {
  erp::GainCommand message;
  for (const auto& [parameter, value] : options.gains) {
    erp::GainValue gain{};
    erp::assign(gain.name, options.actuator);
    erp::assign(gain.parameter, parameter);
    gain.value = value;
    erp::append(message.gains, gain);
  }
  return message;
}

}  // namespace

int set_gains(const SetOptions& options, std::ostream& out) {
  RobotLink link("set", "erp_set_" + std::to_string(getpid()));
  link.find_robots();
  const std::string name = link.choose(options.robot);
  RobotLink::Robot& robot = link.robot(name);
  if (!robot.has_actuator(options.actuator))
    throw std::invalid_argument("the robot has no actuator \"" + options.actuator + "\"; " +
                                xml::did_you_mean(options.actuator, actuators_of(robot)));
  const Counts before = counts_of(robot, options.actuator);
  erp::GainCommand message = message_of(options);
  link.send(message, name, options.priority);
  std::string refused;
  bool accepted = false;
  link.watch(answer_timeout_ns, [&] {
    const Counts now = counts_of(robot, options.actuator);
    accepted = now.accepted != before.accepted;
    if (now.refused_by_ecu != before.refused_by_ecu) refused = "its ECU refuses the gains";
    if (now.refused_by_plant != before.refused_by_plant)
      refused = reason_for(options, *robot.owner(options.actuator));
    return accepted || !refused.empty();
  });
  if (!refused.empty()) throw std::runtime_error(options.actuator + ": " + refused);
  if (!accepted)
    throw std::runtime_error(options.actuator + ": no answer from its ECU; is it on the bus?");
  out << options.actuator << ": accepted\n";
  return 0;
}

}  // namespace launch
